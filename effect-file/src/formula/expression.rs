//! A formula that can be evaluated.

use exmex::{Express, FlatEx, MatchLiteral, literal_matcher_from_pattern};

use super::operators::Operators;
use super::syntax::translated;
use crate::error::Wrong;

literal_matcher_from_pattern!(Numbers, r"^[0-9]+(\.[0-9]+)?(e-?[0-9]+)?");

/// A formula, and the names of which it takes values.
#[derive(Clone, Debug)]
pub(crate) struct Expression {
    /// In the order of their first mention.
    pub(crate) names: Vec<String>,
    /// None of one value, unchanged.
    compiled: Option<FlatEx<f64, Operators, Numbers>>,
}

impl Expression {
    pub(crate) fn parse(formula: &str) -> Result<Self, Wrong> {
        let written = translated(formula)?;
        let compiled = FlatEx::parse(&written.text)
            .map_err(|error| Wrong::new(0, format!("the formula cannot be evaluated: {}", error.msg())))?;
        Ok(Self { names: written.names, compiled: Some(compiled) })
    }

    /// One value, unchanged.
    pub(crate) fn of_one() -> Self {
        Self { names: Vec::new(), compiled: None }
    }

    pub(crate) fn is_of_one(&self) -> bool {
        self.compiled.is_none()
    }

    /// Its value for values of its names in their order; not a number where it has none.
    pub(crate) fn eval(&self, values: &[f64]) -> f64 {
        match &self.compiled {
            Some(compiled) => compiled.eval(values).unwrap_or(f64::NAN),
            None => values.first().copied().unwrap_or(f64::NAN),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Value with `a` = 2, `b` = 3, `c` = -5.
    fn value(formula: &str) -> f64 {
        let expression = Expression::parse(formula).unwrap_or_else(|wrong| panic!("{formula}: {}", wrong.reason));
        let of = |name: &String| match name.as_str() {
            "a" => 2.0,
            "b" => 3.0,
            _ => -5.0,
        };
        expression.eval(&expression.names.iter().map(of).collect::<Vec<f64>>())
    }

    #[test]
    fn precedence_is_that_of_mathematics() {
        for (formula, expected) in [
            ("-a^2", -4.0),
            ("2^-a", 0.25),
            ("b - -a^2", 7.0),
            ("a * -b^2", -18.0),
            ("a / -b * 3", -2.0),
            ("-a * b - c", -1.0),
            ("a - b - c", 4.0),
            ("a / b / 2", 1.0 / 3.0),
            ("(a + b) * c", -25.0),
            ("+a - +b", -1.0),
            ("1e-1 * 2.5E+1 * .5", 1.25),
            ("a + b > 4", 1.0),
            ("(a < b) * 7", 7.0),
            ("min(a, max(b, c)) + max(min(c, b), a) * 10", 22.0),
            ("atan2(a - a, -b)", std::f64::consts::PI),
            ("-sin(pi / 2)^2", -1.0),
            ("2^sqrt(a + a)", 4.0),
            ("signum(c) + abs(c) + floor(2.7)", 6.0),
            ("-(-a)", 2.0),
            ("min_depth*0 + sine*0 + e", -5.0),
        ] {
            assert!((value(formula) - expected).abs() < 1e-12, "{formula}: {} {expected}", value(formula));
        }
    }

    #[test]
    fn what_is_wrong_is_said_with_its_place() {
        let deep = format!("{}a{}", "(".repeat(33), ")".repeat(33));
        for (formula, at, reason) in [
            ("", 0, "empty"),
            ("a +", 3, "a value is missing"),
            ("a b", 2, "an operator is missing"),
            ("2 (a)", 2, "an operator is missing"),
            ("sin a", 0, "parentheses"),
            ("sine(a)", 0, "no function \"sine\""),
            ("a ^ b ^ c", 6, "two ways"),
            ("a < b < c", 6, "compares twice"),
            ("a - - - b", 6, "two signs"),
            ("min(a)", 5, "two values"),
            ("sin(a, b)", 5, "a comma"),
            ("a, b", 1, "a comma"),
            ("(a", 2, "without its )"),
            ("a)", 1, "without its ("),
            ("a = b", 2, "compare with"),
            ("a; b", 1, "';' is no part"),
            ("1e999", 0, "not a number"),
            ("1.2.3", 3, "an operator is missing"),
            ("* a", 0, "no value before *"),
            ("()", 1, "no value before )"),
            (&deep, 32, "more than 32"),
            (&"a+".repeat(4001), 0, "longer than 8000"),
        ] {
            let wrong = Expression::parse(formula).unwrap_err();
            assert!(wrong.at == at && wrong.reason.contains(reason), "{formula}: {wrong:?}");
        }
    }

    /// A formula as a tree, with all its parentheses, and its value by other means.
    fn tree() -> impl Strategy<Value = (String, f64)> {
        let leaf = prop_oneof![
            Just(("a".to_string(), 2.0)),
            Just(("b".to_string(), 3.0)),
            Just(("c".to_string(), -5.0)),
            (0.0..9.0_f64).prop_map(|x| (format!("{x}"), x)),
        ];
        leaf.prop_recursive(5, 40, 2, |inner| {
            prop_oneof![
                (inner.clone(), inner.clone()).prop_map(|(x, y)| (format!("({} + {})", x.0, y.0), x.1 + y.1)),
                (inner.clone(), inner.clone()).prop_map(|(x, y)| (format!("({} - {})", x.0, y.0), x.1 - y.1)),
                (inner.clone(), inner.clone()).prop_map(|(x, y)| (format!("({} * -{})", x.0, y.0), -x.1 * y.1)),
                (inner.clone(), inner.clone()).prop_map(|(x, y)| (format!("min({}, {})", x.0, y.0), x.1.min(y.1))),
                (inner.clone(), inner.clone()).prop_map(|(x, y)| (format!("max({},{})", x.0, y.0), x.1.max(y.1))),
                inner.clone().prop_map(|x| (format!("sin({})", x.0), libm::sin(x.1))),
                inner.prop_map(|x| (format!("(-{})", x.0), -x.1)),
            ]
        })
    }

    proptest! {
        #[test]
        fn any_tree_has_its_value((formula, expected) in tree()) {
            prop_assume!(formula.len() < 2000);
            let Ok(expression) = Expression::parse(&formula) else { return Err(TestCaseError::reject("too deep")) };
            drop(expression);
            let found = value(&formula);
            prop_assert!((found - expected).abs() <= 1e-9 * (1.0 + expected.abs()), "{} {} {}", formula, found, expected);
        }

        #[test]
        fn any_text_is_taken_or_refused(formula in "[abc0-9.e+*/^<>=(), min\\-]{0,60}") {
            if let Ok(expression) = Expression::parse(&formula) {
                expression.eval(&vec![1.5; expression.names.len()]);
            }
        }
    }
}
