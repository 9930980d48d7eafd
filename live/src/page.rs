//! The page: one document, all that it needs within it.

use axum::http::{HeaderName, HeaderValue, header};
use axum::response::{Html, IntoResponse, Response};

const FRAME: &str = include_str!("../page/index.html");
const STYLE: [&str; 2] = [include_str!("../page/uplot.min.css"), include_str!("../page/style.css")];
const SCRIPT: [&str; 9] = [
    include_str!("../page/uplot.min.js"),
    include_str!("../page/format.js"),
    include_str!("../page/store.js"),
    include_str!("../page/strip.js"),
    include_str!("../page/track.js"),
    include_str!("../page/alarm.js"),
    include_str!("../page/panel.js"),
    include_str!("../page/link.js"),
    include_str!("../page/main.js"),
];

/// The page, and what its browser is told of it.
#[derive(Clone, Debug)]
pub(crate) struct Page {
    document: String,
    policy: HeaderValue,
}

impl Page {
    /// The page; scripts and styles without `nonce` do not run in it.
    pub(crate) fn new(nonce: &str) -> Self {
        let document = FRAME
            .replace("{{nonce}}", nonce)
            .replace("{{style}}", &STYLE.join("\n"))
            .replace("{{script}}", &SCRIPT.join("\n"));
        let policy = format!(
            "default-src 'none'; script-src 'nonce-{nonce}'; style-src 'nonce-{nonce}'; connect-src 'self'; img-src data:; \
             base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
        );
        // Letters and digits are a header's value.
        let policy = HeaderValue::from_str(&policy).unwrap_or(HeaderValue::from_static("default-src 'none'"));
        Self { document, policy }
    }

    /// As an answer.
    pub(crate) fn response(&self) -> Response {
        let fixed: [(HeaderName, &str); 3] = [
            (header::CACHE_CONTROL, "no-store"),
            (header::REFERRER_POLICY, "no-referrer"),
            (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
        ];
        ([(header::CONTENT_SECURITY_POLICY, self.policy.clone())], fixed, Html(self.document.clone())).into_response()
    }
}
