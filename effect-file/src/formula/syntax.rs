//! The grammar of formulas: word by word, with a stack of its own in place of recursion, and into the text that the library
//! evaluates, in which no precedence is left that it sees otherwise than mathematics.

use super::lexer::{Token, What, tokens};
use super::operators::{FUNCTIONS, NEGATED};
use crate::error::{Wrong, quoted};
use crate::limits::{LONGEST_FORMULA, LONGEST_NAME, MOST_DEPTH, MOST_NAMES};

/// A formula in the library's words.
pub(super) struct Translated {
    /// Its names are `v000`, `v001`, ..., whose order is that of `names`.
    pub(super) text: String,
    pub(super) names: Vec<String>,
}

/// Check a formula and write it in the library's words.
pub(super) fn translated(formula: &str) -> Result<Translated, Wrong> {
    if formula.chars().count() > LONGEST_FORMULA {
        return Err(Wrong::new(0, format!("the formula is longer than {LONGEST_FORMULA} characters")));
    }
    let tokens = tokens(formula)?;
    let mut writer = Writer::default();
    for (index, token) in tokens.iter().enumerate() {
        let is_call = matches!(tokens.get(index + 1), Some(Token { what: What::Open, .. }));
        writer.take(token.what, is_call).map_err(|reason| Wrong::new(token.at, reason))?;
    }
    writer.end().map_err(|reason| Wrong::new(formula.len(), reason))
}

/// What has been written, and what may come next.
struct Writer {
    text: String,
    names: Vec<String>,
    /// What is open, the whole formula first.
    open: Vec<Open>,
    /// Whether a value was the last thing, after which an operator comes.
    has_value: bool,
    /// The sign or function that was the last thing.
    last: Last,
}

/// The last thing, where a value is to come.
#[derive(Clone, Copy, PartialEq)]
enum Last {
    Power,
    Sign,
    Function,
    Other,
}

/// A pair of parentheses that is still open, or the whole.
#[derive(Clone, Copy, Default)]
struct Open {
    /// Commas that are still to come.
    commas: usize,
    /// The library's sign of a function of two values, which stands between them.
    between: Option<&'static str>,
    /// Whether the last operator of two values was a power, or a comparison.
    was_power: bool,
    was_comparison: bool,
}

impl Default for Writer {
    fn default() -> Self {
        Self {
            text: String::new(),
            names: Vec::new(),
            open: vec![Open::default()],
            has_value: false,
            last: Last::Other,
        }
    }
}

impl Writer {
    fn take(&mut self, what: What<'_>, is_call: bool) -> Result<(), String> {
        match what {
            What::Number(value) => self.value(&format!("{value:?}")),
            What::Name(name) if is_call => self.function(name),
            What::Name("pi") => self.value(&format!("{:?}", std::f64::consts::PI)),
            What::Name(name) => self.name(name),
            What::Operator(sign) if self.has_value => self.operator(sign),
            What::Operator(sign) => self.sign(sign),
            What::Open => self.parenthesis(),
            What::Comma => self.comma(),
            What::Close => self.close(),
        }
    }

    fn value(&mut self, text: &str) -> Result<(), String> {
        self.needs_no_value("a value")?;
        self.text.push_str(text);
        (self.has_value, self.last) = (true, Last::Other);
        Ok(())
    }

    fn name(&mut self, name: &str) -> Result<(), String> {
        if FUNCTIONS.iter().any(|(known, ..)| *known == name) {
            return Err(format!("the function {name} needs its value in parentheses"));
        }
        if name.len() > LONGEST_NAME {
            return Err(format!("the name {} is longer than {LONGEST_NAME} characters", quoted(name)));
        }
        let known = self.names.iter().position(|known| known == name);
        let index = known.unwrap_or(self.names.len());
        if index >= MOST_NAMES {
            return Err(format!("the formula has more than {MOST_NAMES} names"));
        }
        self.value(&format!("v{index:03}"))?;
        if known.is_none() {
            self.names.push(name.into());
        }
        Ok(())
    }

    /// Its parenthesis comes next.
    fn function(&mut self, name: &str) -> Result<(), String> {
        self.needs_no_value("a function")?;
        let Some((_, values, sign)) = FUNCTIONS.iter().find(|(known, ..)| *known == name) else {
            let known: Vec<&str> = FUNCTIONS.iter().map(|(known, ..)| *known).collect();
            return Err(format!("there is no function {}; there are {}", quoted(name), known.join(", ")));
        };
        self.deeper()?;
        if *values == 1 {
            self.text.push_str(sign);
            self.open.push(Open::default());
        } else {
            // Two values with the function's sign between them, each in parentheses, and around all.
            self.text.push('(');
            self.open.push(Open { commas: 1, between: Some(sign), ..Open::default() });
        }
        self.last = Last::Function;
        Ok(())
    }

    fn parenthesis(&mut self) -> Result<(), String> {
        self.needs_no_value("(")?;
        if self.last != Last::Function {
            self.deeper()?;
            self.open.push(Open::default());
        }
        self.text.push('(');
        self.last = Last::Other;
        Ok(())
    }

    fn comma(&mut self) -> Result<(), String> {
        self.needs_value(",")?;
        let top = self.open.last_mut().filter(|top| top.commas > 0);
        let top = top.ok_or("a comma stands between the two values of min, max or atan2 alone")?;
        let sign = top.between.unwrap_or_default();
        *top = Open { commas: 0, between: Some(sign), ..Open::default() };
        self.text.push(')');
        self.text.push_str(sign);
        self.text.push('(');
        (self.has_value, self.last) = (false, Last::Other);
        Ok(())
    }

    fn close(&mut self) -> Result<(), String> {
        self.needs_value(")")?;
        if self.open.len() == 1 {
            return Err("there is a ) without its (".into());
        }
        let closed = self.open.pop().unwrap_or_default();
        if closed.commas > 0 {
            return Err("min, max and atan2 need two values".into());
        }
        self.text.push_str(if closed.between.is_some() { "))" } else { ")" });
        Ok(())
    }

    /// An operator between two values.
    fn operator(&mut self, sign: &str) -> Result<(), String> {
        let Some(top) = self.open.last_mut() else { return Err("there is a ) without its (".into()) };
        let (is_power, is_comparison) = (sign == "^", sign.starts_with(['<', '>']));
        if is_power && top.was_power {
            return Err("a ^ b ^ c can be read in two ways: write a ^ (b ^ c) or (a ^ b) ^ c".into());
        }
        if is_comparison && top.was_comparison {
            return Err("a < b < c compares twice: write (a < b) * (b < c)".into());
        }
        top.was_power = is_power;
        top.was_comparison |= is_comparison;
        self.text.push_str(sign);
        (self.has_value, self.last) = (false, if is_power { Last::Power } else { Last::Other });
        Ok(())
    }

    /// A sign before a value.
    fn sign(&mut self, sign: &str) -> Result<(), String> {
        if self.last == Last::Sign {
            return Err("there are two signs before a value: write parentheses".into());
        }
        match (sign, self.last) {
            ("+", _) => {}
            ("-", Last::Power) => self.text.push('-'),
            ("-", _) => {
                self.text.push('0');
                self.text.push_str(NEGATED);
            }
            _ => return Err(format!("there is no value before {sign}")),
        }
        self.last = Last::Sign;
        Ok(())
    }

    fn needs_no_value(&self, what: &str) -> Result<(), String> {
        if self.has_value { Err(format!("{what} cannot follow a value: an operator is missing")) } else { Ok(()) }
    }

    fn needs_value(&self, what: &str) -> Result<(), String> {
        if self.has_value { Ok(()) } else { Err(format!("there is no value before {what}")) }
    }

    fn deeper(&self) -> Result<(), String> {
        match self.open.len() > MOST_DEPTH {
            true => Err(format!("more than {MOST_DEPTH} parentheses within each other")),
            false => Ok(()),
        }
    }

    fn end(self) -> Result<Translated, String> {
        match (self.has_value, self.open.len()) {
            _ if self.text.is_empty() => Err("the formula is empty".into()),
            (false, _) => Err("the formula ends where a value is missing".into()),
            (true, 1) => Ok(Translated { text: self.text, names: self.names }),
            (true, _) => Err("there is a ( without its )".into()),
        }
    }
}
