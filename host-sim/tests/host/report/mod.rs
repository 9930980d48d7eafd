//! What the tests of the pages show, and the browser they show it in.

pub(crate) mod browser;
pub(crate) mod demo;
pub(crate) mod demo_diagnosis;
pub(crate) mod demo_survey;
