//! The two things that there are: the page, and what it is told.

use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::extract::ws::WebSocketUpgrade;
use axum::extract::{FromRequestParts, Query, State};
use axum::http::StatusCode;
use axum::http::request::Parts;
use axum::response::{IntoResponse, Response};
use axum::routing::get;
use serde::Deserialize;

use crate::connection::Caller;
use crate::guard::{Guard, Rights};
use crate::hub::Hub;
use crate::page::Page;
use crate::viewer::Viewer;
use crate::wish::LONGEST_MESSAGE;

/// What a viewer that does not read may leave in memory, bytes: the longest message, the history of a window with its
/// track, is a third of it.
const LONGEST_WAIT: usize = 1 << 20;

/// What is served.
#[derive(Clone)]
pub(crate) struct Served {
    pub(crate) hub: Arc<Hub>,
    pub(crate) guard: Guard,
    pub(crate) page: Page,
    pub(crate) patience: Duration,
}

/// The two things that there are; all else is not found, whatever its path.
pub(crate) fn router(served: Served) -> Router {
    Router::new().route("/", get(page)).route("/live", get(live)).with_state(Arc::new(served))
}

async fn page(_: Admitted, State(served): State<Arc<Served>>) -> Response {
    served.page.response()
}

async fn live(admitted: Admitted, State(served): State<Arc<Served>>, upgrade: WebSocketUpgrade) -> Response {
    let Admitted { rights, caller } = admitted;
    let upgrade = upgrade.max_message_size(LONGEST_MESSAGE).max_frame_size(LONGEST_MESSAGE);
    let upgrade = upgrade.write_buffer_size(0).max_write_buffer_size(LONGEST_WAIT);
    upgrade.on_upgrade(async move |socket| {
        let _place = caller.into_place();
        Viewer::new(socket, &served.hub, rights, served.patience).run().await;
    })
}

/// Somebody who is let in, and what for.
struct Admitted {
    rights: Rights,
    caller: Caller,
}

#[derive(Deserialize)]
struct Shown {
    token: Option<String>,
}

impl FromRequestParts<Arc<Served>> for Admitted {
    type Rejection = Response;

    async fn from_request_parts(parts: &mut Parts, served: &Arc<Served>) -> Result<Self, Response> {
        let refused = || {
            (StatusCode::FORBIDDEN, "Not from here, or not without the token that `listen` has printed.\n")
                .into_response()
        };
        let caller = parts.extensions.get::<Caller>().cloned().ok_or_else(refused)?;
        let shown = Query::<Shown>::try_from_uri(&parts.uri).map_err(|_| refused())?;
        let rights = served.guard.admit(caller.address, &parts.headers, shown.token.as_deref()).ok_or_else(refused)?;
        Ok(Self { rights, caller })
    }
}
