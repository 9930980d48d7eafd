//! Which effects are at work in a channel: the best one is added, everything is fitted again, and so on, until what is
//! left is no more than noise. Then each is taken out again, to see whether it is needed and what else would do.

mod acceptance;
mod louder;
mod outliers;
mod refine;
mod review;
mod select;
mod state;
mod stepwise;

pub(crate) use acceptance::log_false_alarm;
pub(crate) use select::{Asked, Selection, select};
pub(crate) use state::Accepted;
