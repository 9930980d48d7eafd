//! Who may look, and who may do more.

use std::net::IpAddr;

use axum::http::uri::Authority;
use axum::http::{HeaderMap, HeaderName, header};

/// What a viewer may do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rights {
    /// A viewer on another machine.
    Look,
    /// A viewer on this machine: marks, and seen alarms.
    Mark,
    /// The same where commands are allowed.
    Command,
}

impl Rights {
    pub(crate) fn may_mark(self) -> bool {
        self != Self::Look
    }

    pub(crate) fn may_command(self) -> bool {
        self == Self::Command
    }
}

/// Who is let in.
#[derive(Clone, Debug)]
pub(crate) struct Guard {
    /// What viewers on other machines have to show.
    pub(crate) token: String,
    pub(crate) allow_commands: bool,
}

impl Guard {
    /// What a request from this address may do; `None`: nothing at all.
    pub(crate) fn admit(&self, peer: IpAddr, headers: &HeaderMap, token: Option<&str>) -> Option<Rights> {
        let host: Authority = only(headers, &header::HOST)??.parse().ok()?;
        if !is_own_name(host.host()) {
            return None;
        }
        match only(headers, &header::ORIGIN)? {
            Some(origin) if !origin.strip_prefix("http://")?.eq_ignore_ascii_case(host.as_str()) => return None,
            _ => {}
        }
        match (peer.to_canonical().is_loopback(), self.allow_commands) {
            (true, true) => Some(Rights::Command),
            (true, false) => Some(Rights::Mark),
            (false, _) => token.is_some_and(|token| is_same(token, &self.token)).then_some(Rights::Look),
        }
    }
}

/// Whether a page that a browser takes for one of this server can only be one: a name can be made to lead here by
/// whoever owns it (DNS rebinding), a bare address cannot.
fn is_own_name(host: &str) -> bool {
    let bare = host.strip_prefix('[').and_then(|host| host.strip_suffix(']')).unwrap_or(host);
    bare.eq_ignore_ascii_case("localhost") || bare.parse::<IpAddr>().is_ok()
}

/// The value of a header that may be there once: `None` where it is there twice, or is no text.
fn only<'a>(headers: &'a HeaderMap, name: &HeaderName) -> Option<Option<&'a str>> {
    let mut values = headers.get_all(name).iter();
    match (values.next(), values.next()) {
        (None, _) => Some(None),
        (Some(value), None) => value.to_str().ok().map(Some),
        _ => None,
    }
}

/// In a time that does not tell how much of it is right.
fn is_same(given: &str, own: &str) -> bool {
    let pairs = given.bytes().zip(own.bytes());
    given.len() == own.len() && pairs.fold(0, |other, (a, b)| other | (a ^ b)) == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn headers(pairs: &[(HeaderName, &str)]) -> HeaderMap {
        pairs.iter().map(|(name, value)| (name.clone(), value.parse().unwrap())).fold(
            HeaderMap::new(),
            |mut all, (name, value)| {
                all.append(name, value);
                all
            },
        )
    }

    fn admitted(peer: &str, pairs: &[(HeaderName, &str)], token: Option<&str>) -> Option<Rights> {
        let guard = Guard { token: "s3cret".into(), allow_commands: false };
        guard.admit(peer.parse().unwrap(), &headers(pairs), token)
    }

    const OWN: &str = "127.0.0.1";
    const OTHER: &str = "192.168.1.7";

    #[test]
    fn this_machine_marks_and_others_look_with_the_token() {
        let host = [(header::HOST, "192.168.1.5:8080")];
        assert_eq!(admitted(OWN, &host, None), Some(Rights::Mark));
        assert_eq!(admitted("::1", &[(header::HOST, "[::1]:8080")], None), Some(Rights::Mark));
        assert_eq!(admitted(OTHER, &host, Some("s3cret")), Some(Rights::Look));
        for token in [None, Some(""), Some("s3cre"), Some("s3cret0"), Some("S3cret")] {
            assert_eq!(admitted(OTHER, &host, token), None);
        }
        let commands = Guard { token: "t".into(), allow_commands: true };
        assert_eq!(commands.admit(OWN.parse().unwrap(), &headers(&host), None), Some(Rights::Command));
        assert_eq!(commands.admit(OTHER.parse().unwrap(), &headers(&host), Some("t")), Some(Rights::Look));
    }

    #[test]
    fn no_page_of_others_reaches_the_server() {
        let host = |name| (header::HOST, name);
        let origin = |name| (header::ORIGIN, name);
        assert!(admitted(OWN, &[host("localhost:8080"), origin("http://LOCALHOST:8080")], None).is_some());
        for pairs in [
            vec![],
            vec![host("evil.example:8080")],
            vec![host("127.0.0.1.evil.example")],
            vec![host("localhost:8080"), host("evil.example")],
            vec![host("localhost:8080"), origin("http://evil.example")],
            vec![host("localhost:8080"), origin("http://localhost:8081")],
            vec![host("localhost:8080"), origin("https://localhost:8080")],
            vec![host("localhost:8080"), origin("null")],
            vec![host("a b")],
        ] {
            assert_eq!(admitted(OWN, &pairs, Some("s3cret")), None, "{pairs:?}");
        }
    }
}
