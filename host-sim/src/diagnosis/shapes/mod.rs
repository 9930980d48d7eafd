//! Shapes that anything recorded may drive: formulas in the language of effect files, in families by their input, and how much likelier a
//! family makes a residual.

pub(crate) mod expression;
pub(crate) mod filter;
pub(crate) mod group;
pub(crate) mod inputs;
pub(crate) mod ridge;
pub(crate) mod scene;
