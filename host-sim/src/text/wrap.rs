//! Text in lines.

/// `text` in lines of at most `width` characters; a longer word has a line of its own.
pub(crate) fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.into()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_full_and_no_word_is_lost() {
        assert_eq!(wrapped("a tone of 10⁻⁵ nT", 9), ["a tone of", "10⁻⁵ nT"]);
        assert_eq!(wrapped("unmagnetised it", 5), ["unmagnetised", "it"]);
    }
}
