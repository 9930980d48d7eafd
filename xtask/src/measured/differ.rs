//! Whether two figures say the same.

/// Lines in which two figures differ, the first as it stands and as it was measured; `None` where they say the same.
///
/// Numbers may differ by one in their last digit, and by a share of their size where they change from run to run.
pub(super) fn difference(stands: &str, measured: &str, share: f64) -> Option<String> {
    let (stands, measured) = (stands.trim(), measured.trim());
    if stands.lines().count() != measured.lines().count() {
        return Some(format!("stands:\n{stands}\nmeasured:\n{measured}"));
    }
    let pairs = stands.lines().zip(measured.lines()).filter(|(a, b)| !says_the_same(a, b, share));
    let lines: Vec<String> = pairs.map(|(a, b)| format!("  stands:   {a}\n  measured: {b}")).collect();
    (!lines.is_empty()).then(|| lines.join("\n"))
}

fn says_the_same(a: &str, b: &str, share: f64) -> bool {
    let (a, b) = (pieces(a), pieces(b));
    a.len() == b.len() && a.iter().zip(&b).all(|(a, b)| a == b || is_near(a, b, share))
}

/// Numbers, and what stands between them.
fn pieces(line: &str) -> Vec<String> {
    let mut pieces: Vec<(bool, String)> = Vec::new();
    for character in line.chars().filter(|character| *character != ' ') {
        let is_number = character.is_ascii_digit() || matches!(character, '.' | ',');
        match pieces.last_mut() {
            Some((same, piece)) if *same == is_number => piece.push(character),
            _ => pieces.push((is_number, character.to_string())),
        }
    }
    pieces.into_iter().map(|(_, piece)| piece).collect()
}

fn is_near(a: &str, b: &str, share: f64) -> bool {
    let [Some((a, step_a)), Some((b, step_b))] = [number(a), number(b)] else { return false };
    let allowed = step_a.max(step_b) * 1.001;
    (a - b).abs() <= allowed.max(share * a.abs().max(b.abs()))
}

/// A number and the size of its last digit. Commas only group its digits.
fn number(text: &str) -> Option<(f64, f64)> {
    let digits = text.replace(',', "");
    let decimals = digits.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    Some((digits.parse().ok()?, 10_f64.powi(-i32::try_from(decimals).ok()?)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_digit_may_differ() {
        assert_eq!(difference("| a | 1.408 |\n", "| a | 1.409 |", 0.0), None);
        assert!(difference("| a | 1.408 |", "| a | 1.411 |", 0.0).is_some());
        assert!(difference("| a | 1.408 |", "| b | 1.408 |", 0.0).is_some());
        assert!(difference("one line", "two\nlines", 0.0).is_some());
    }

    #[test]
    fn a_share_is_for_what_changes_from_run_to_run() {
        assert_eq!(difference("960,000 a second", "1,050,000 a second", 0.2), None);
        assert!(difference("960,000 a second", "1,250,000 a second", 0.2).is_some());
    }

    #[test]
    fn only_what_differs_is_shown() {
        let shown = difference("same 1\nother 2", "same 1\nother 5", 0.0).unwrap();
        assert_eq!(shown, "  stands:   other 2\n  measured: other 5");
    }
}
