//! The page that holds the figures, between markers: `<!-- measured: NAME -->` ... `<!-- end -->`.

use anyhow::{Context, Result, ensure};

/// Before a figure's name, and after it.
const OPEN: [&str; 2] = ["<!-- measured: ", " -->\n"];
/// After a figure.
const CLOSE: &str = "<!-- end -->";

/// The names of a page's figures, in its order.
#[cfg(test)]
pub(super) fn names(page: &str) -> Vec<&str> {
    page.split(OPEN[0]).skip(1).filter_map(|rest| Some(rest.split_once(OPEN[1])?.0)).collect()
}

/// A figure as it stands on a page, if it does.
pub(super) fn figure<'a>(page: &'a str, name: &str) -> Result<Option<&'a str>> {
    if !page.contains(&opening(name)) {
        return Ok(None);
    }
    let (from, to) = bounds(page, name)?;
    Ok(Some(&page[from..to]))
}

/// The page with another figure in that place.
pub(super) fn with_figure(page: &str, name: &str, figure: &str) -> Result<String> {
    let (from, to) = bounds(page, name)?;
    Ok(format!("{}{}\n{}", &page[..from], figure.trim_end(), &page[to..]))
}

/// What stands before a figure.
fn opening(name: &str) -> String {
    OPEN.join(name)
}

/// Where a figure begins and ends, bytes.
fn bounds(page: &str, name: &str) -> Result<(usize, usize)> {
    let open = opening(name);
    let from = page.find(&open).with_context(|| format!("the page has no `{}`", open.trim_end()))? + open.len();
    let len = page[from..].find(CLOSE).with_context(|| format!("`{}` has no `{CLOSE}`", open.trim_end()))?;
    ensure!(!page[from..from + len].contains(OPEN[0]), "`{}` has no `{CLOSE}`", open.trim_end());
    Ok((from, from + len))
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAGE: &str = "# a\n<!-- measured: one -->\n1\n<!-- end -->\nb\n<!-- measured: two -->\n2\n<!-- end -->\n";

    #[test]
    fn figures_are_found_and_replaced() {
        assert_eq!(names(PAGE), ["one", "two"]);
        assert_eq!(figure(PAGE, "two").unwrap(), Some("2\n"));
        assert_eq!(figure(PAGE, "three").unwrap(), None);
        let other = with_figure(PAGE, "one", "| 3 |\n").unwrap();
        assert_eq!(other, PAGE.replace("\n1\n", "\n| 3 |\n"));
    }

    #[test]
    fn a_lost_marker_is_an_error() {
        assert!(with_figure(PAGE, "three", "").is_err());
        assert!(figure(&PAGE.replacen("<!-- end -->", "", 1), "one").is_err());
    }
}
