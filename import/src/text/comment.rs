//! Lines that are comments.

/// What comments begin with.
const COMMENTS: [&str; 6] = ["#", "//", "%", "!", "/", "'"];

/// Whether a line is a comment.
pub(super) fn is_comment(line: &str) -> bool {
    let line = line.trim_start();
    COMMENTS.iter().any(|mark| line.starts_with(mark))
}

/// The same without the mark.
pub(super) fn without_mark(line: &str) -> &str {
    let line = line.trim_start();
    COMMENTS.iter().find_map(|mark| line.strip_prefix(mark)).unwrap_or(line).trim_start_matches(['#', '/', '%'])
}
