//! Where the emulated body and its replay part.

/// The first difference between the body and its replay.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub struct Difference {
    pub(super) what: &'static str,
    pub(super) session: usize,
    pub(super) index: usize,
    pub(super) body: Option<String>,
    pub(super) replay: Option<String>,
}

impl std::fmt::Display for Difference {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { what, session, index, body, replay } = self;
        write!(f, "{what}, start {session}, epoch {index}: ")?;
        match (body, replay) {
            (Some(body), Some(replay)) => write!(f, "body {body}, replay {replay}"),
            (Some(body), None) => write!(f, "only the body has {body}"),
            (None, Some(replay)) => write!(f, "only the replay has {replay}"),
            (None, None) => write!(f, "nothing"),
        }
    }
}
