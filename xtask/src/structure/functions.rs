//! How long functions are.

use std::path::Path;

use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{Block, Item};

use super::source::SourceCrate;

/// A function and the lines of its body.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Function {
    /// Its file, relative to the root of the repository.
    pub file: String,
    /// Its name.
    pub name: String,
    /// Lines of its body, from the line of one brace to that of the other.
    pub lines: usize,
}

/// Functions and methods of a crate, those within functions too; closures and what is there for tests are not counted.
pub fn functions(source: &SourceCrate) -> Vec<Function> {
    let mut functions = Vec::new();
    for module in &source.modules {
        functions.extend(functions_of(&module.file, &module.items));
    }
    functions
}

fn functions_of(file: &Path, items: &[Item]) -> Vec<Function> {
    let mut counter = Counter { file: crate::repository::relative(file), functions: Vec::new() };
    items.iter().for_each(|item| counter.visit_item(item));
    counter.functions
}

struct Counter {
    file: String,
    functions: Vec<Function>,
}

impl Counter {
    fn count(&mut self, name: &syn::Ident, body: &Block) {
        let span = body.span();
        let lines = span.end().line - span.start().line + 1;
        self.functions.push(Function { file: self.file.clone(), name: name.to_string(), lines });
    }
}

impl<'ast> Visit<'ast> for Counter {
    fn visit_item_fn(&mut self, function: &'ast syn::ItemFn) {
        self.count(&function.sig.ident, &function.block);
        visit::visit_item_fn(self, function);
    }

    fn visit_impl_item_fn(&mut self, function: &'ast syn::ImplItemFn) {
        self.count(&function.sig.ident, &function.block);
        visit::visit_impl_item_fn(self, function);
    }

    fn visit_trait_item_fn(&mut self, function: &'ast syn::TraitItemFn) {
        if let Some(body) = &function.default {
            self.count(&function.sig.ident, body);
        }
        visit::visit_trait_item_fn(self, function);
    }
}

/// Length of functions: half, nine in ten and all of them have at most so many lines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Shape {
    /// How many there are.
    pub count: usize,
    /// Lines of the one in the middle.
    pub median: usize,
    /// Lines that nine in ten do not exceed.
    pub p90: usize,
    /// Lines of the longest.
    pub longest: usize,
}

impl Shape {
    /// Of so many functions; zeros of none.
    pub fn of<'a>(functions: impl IntoIterator<Item = &'a Function>) -> Self {
        let mut lines: Vec<usize> = functions.into_iter().map(|function| function.lines).collect();
        lines.sort_unstable();
        let at = |share: f64| {
            let rank = (share * lines.len() as f64).ceil() as usize;
            lines.get(rank.saturating_sub(1)).copied().unwrap_or_default()
        };
        Self { count: lines.len(), median: at(0.5), p90: at(0.9), longest: at(1.0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(text: &str) -> Vec<(String, usize)> {
        let functions = functions_of(Path::new("x.rs"), &syn::parse_file(text).unwrap().items);
        functions.into_iter().map(|function| (function.name, function.lines)).collect()
    }

    #[test]
    fn the_lines_of_the_body_are_counted() {
        let text = "fn a() {}\nfn b(\n    x: u8,\n) {\n    one();\n    // two\n    three();\n}\nimpl X {\n fn c() {\n 1\n }\n}\n";
        let expected = [("a", 1), ("b", 5), ("c", 3)].map(|(name, lines)| (name.to_string(), lines));
        assert_eq!(lines(text), expected);
    }

    #[test]
    fn nine_in_ten_are_no_longer_than_the_ninth() {
        let function = |lines| Function { file: String::new(), name: String::new(), lines };
        let functions: Vec<Function> = (1..=10).map(function).collect();
        assert_eq!(Shape::of(&functions), Shape { count: 10, median: 5, p90: 9, longest: 10 });
        assert_eq!(Shape::of(&[]), Shape::default());
    }
}
