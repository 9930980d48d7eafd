//! What a formula can calculate, for the library that evaluates it. By `libm`, so that a value has the same bits everywhere.

use exmex::{BinOp, MakeOperators, Operator};

/// Functions by their names: how many values they take, and the sign by which the library knows them.
pub(crate) const FUNCTIONS: [(&str, usize, &str); 16] = [
    ("sin", 1, "sin"),
    ("cos", 1, "cos"),
    ("tan", 1, "tan"),
    ("asin", 1, "asin"),
    ("acos", 1, "acos"),
    ("atan", 1, "atan"),
    ("atan2", 2, "@"),
    ("exp", 1, "exp"),
    ("ln", 1, "ln"),
    ("sqrt", 1, "sqrt"),
    ("abs", 1, "abs"),
    ("signum", 1, "signum"),
    ("tanh", 1, "tanh"),
    ("floor", 1, "floor"),
    ("min", 2, "&"),
    ("max", 2, "|"),
];

/// A minus before a value. It binds less than a power and more than a product, which no sign before a value of the library
/// does: it is written there as a difference from 0.
pub(super) const NEGATED: &str = "~";

pub(crate) fn is_function(name: &str) -> bool {
    FUNCTIONS.iter().any(|(known, ..)| *known == name)
}

/// The operators of the formulas.
#[derive(Clone, Debug)]
pub(crate) struct Operators;

impl MakeOperators<f64> for Operators {
    fn make<'a>() -> Vec<Operator<'a, f64>> {
        let two = |sign: &'a str, prio: i64, apply: fn(f64, f64) -> f64| {
            Operator::make_bin(sign, BinOp { apply, prio, is_commutative: false })
        };
        let minus = BinOp { apply: |a: f64, b: f64| a - b, prio: 1, is_commutative: false };
        vec![
            two("<", 0, |a, b| f64::from(u8::from(a < b))),
            two("<=", 0, |a, b| f64::from(u8::from(a <= b))),
            two(">", 0, |a, b| f64::from(u8::from(a > b))),
            two(">=", 0, |a, b| f64::from(u8::from(a >= b))),
            two("+", 1, |a, b| a + b),
            // Also a sign, which binds most: it is only written after a power.
            Operator::make_bin_unary("-", minus, |a| -a),
            two("*", 2, |a, b| a * b),
            two("/", 2, |a, b| a / b),
            two(NEGATED, 3, |_, b| -b),
            two("^", 4, libm::pow),
            two("&", 5, f64::min),
            two("|", 5, f64::max),
            two("@", 5, libm::atan2),
            Operator::make_unary("sin", libm::sin),
            Operator::make_unary("cos", libm::cos),
            Operator::make_unary("tan", libm::tan),
            Operator::make_unary("asin", libm::asin),
            Operator::make_unary("acos", libm::acos),
            Operator::make_unary("atan", libm::atan),
            Operator::make_unary("exp", libm::exp),
            Operator::make_unary("ln", libm::log),
            Operator::make_unary("sqrt", libm::sqrt),
            Operator::make_unary("abs", f64::abs),
            Operator::make_unary("signum", |a| {
                if a > 0.0 {
                    1.0
                } else if a < 0.0 {
                    -1.0
                } else {
                    a
                }
            }),
            Operator::make_unary("tanh", libm::tanh),
            Operator::make_unary("floor", libm::floor),
        ]
    }
}
