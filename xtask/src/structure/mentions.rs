//! The paths that the code of a module mentions.

use std::collections::BTreeSet;

use proc_macro2::{TokenStream, TokenTree};
use syn::parse::Parser;
use syn::punctuated::Punctuated;
use syn::visit::{self, Visit};
use syn::{Attribute, Expr, ExprCall, ExprPath, ItemUse, Macro, PatIdent, Path, Token, Visibility};

use super::cfg_test::is_for_tests;
use super::scope::Segments;
use super::source::Module;

/// Paths of a module's code, each once. Imports, attributes and `pub(in path)` are no mention.
#[derive(Debug, Default)]
pub(super) struct Mentions {
    paths: BTreeSet<Segments>,
    called: BTreeSet<Segments>,
    variables: BTreeSet<String>,
}

impl Mentions {
    pub(super) fn of(module: &Module) -> BTreeSet<Segments> {
        let mut mentions = Self::default();
        module.items.iter().for_each(|item| mentions.visit_item(item));
        let Self { mut paths, called, variables } = mentions;
        // A variable hides an item of its name, where it is not called.
        paths.retain(|path| path.len() > 1 || !variables.contains(&path[0]));
        paths.extend(called);
        paths
    }

    /// The tokens of a macro that is not made of expressions: whatever looks like a path.
    fn scan(&mut self, tokens: TokenStream) {
        let mut path: Segments = Vec::new();
        let mut colons = 0;
        let mut after_dot = false;
        for token in tokens {
            match token {
                TokenTree::Punct(mark) if mark.as_char() == ':' => colons += 1,
                TokenTree::Ident(word) => {
                    if colons != 2 {
                        self.finish(&mut path);
                    }
                    if !after_dot {
                        path.push(word.to_string());
                    }
                    (colons, after_dot) = (0, false);
                }
                other => {
                    self.finish(&mut path);
                    colons = 0;
                    after_dot = matches!(&other, TokenTree::Punct(mark) if mark.as_char() == '.');
                    if let TokenTree::Group(group) = other {
                        self.scan(group.stream());
                    }
                }
            }
        }
        self.finish(&mut path);
    }

    fn finish(&mut self, path: &mut Segments) {
        if !path.is_empty() {
            self.paths.insert(std::mem::take(path));
        }
    }
}

fn segments(path: &Path) -> Segments {
    path.segments.iter().map(|segment| segment.ident.to_string()).collect()
}

impl<'ast> Visit<'ast> for Mentions {
    fn visit_path(&mut self, path: &'ast Path) {
        if path.leading_colon.is_none() {
            self.paths.insert(segments(path));
        }
        visit::visit_path(self, path);
    }

    fn visit_expr_call(&mut self, call: &'ast ExprCall) {
        if let Expr::Path(ExprPath { path, qself: None, .. }) = &*call.func {
            self.called.insert(segments(path));
        }
        visit::visit_expr_call(self, call);
    }

    fn visit_pat_ident(&mut self, pattern: &'ast PatIdent) {
        let name = pattern.ident.to_string();
        if name.starts_with(char::is_uppercase) {
            self.paths.insert(vec![name]);
        } else {
            self.variables.insert(name);
        }
        visit::visit_pat_ident(self, pattern);
    }

    fn visit_macro(&mut self, call: &'ast Macro) {
        self.called.insert(segments(&call.path));
        let tokens = &call.tokens;
        let of_expressions = Punctuated::<Expr, Token![,]>::parse_terminated.parse2(tokens.clone());
        match of_expressions {
            Ok(expressions) => expressions.iter().for_each(|expression| self.visit_expr(expression)),
            Err(_) => self.scan(tokens.clone()),
        }
    }

    fn visit_item(&mut self, item: &'ast syn::Item) {
        if !is_for_tests(super::source::attributes(item)) {
            visit::visit_item(self, item);
        }
    }

    fn visit_impl_item_fn(&mut self, function: &'ast syn::ImplItemFn) {
        if !is_for_tests(&function.attrs) {
            visit::visit_impl_item_fn(self, function);
        }
    }

    fn visit_item_use(&mut self, _: &'ast ItemUse) {}

    fn visit_attribute(&mut self, _: &'ast Attribute) {}

    fn visit_visibility(&mut self, _: &'ast Visibility) {}
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mentions(text: &str) -> Vec<String> {
        let items = syn::parse_file(text).unwrap().items;
        let module = Module { file: "x.rs".into(), parent: None, children: Vec::new(), items };
        Mentions::of(&module).into_iter().map(|path| path.join("::")).collect()
    }

    #[test]
    fn types_calls_patterns_and_bounds_are_mentioned() {
        let text = "fn f<T: a::Bound>(x: b::Type) -> C { match d::call(x) { E::One => F { x }, LAST => x } }";
        assert_eq!(mentions(text), ["C", "E::One", "F", "LAST", "a::Bound", "b::Type", "d::call"]);
    }

    #[test]
    fn macros_are_looked_into() {
        let text = r#"fn f(x: u8) { println!("{}", a::b(x)); table! { x => c::d, .skipped } }"#;
        assert_eq!(mentions(text), ["a::b", "c::d", "println", "table", "u8"]);
    }

    #[test]
    fn imports_attributes_and_visibility_are_not() {
        assert_eq!(mentions("use a::B; #[derive(C)] pub(in crate::d) struct E; pub use f::G;"), [""; 0]);
    }

    #[test]
    fn a_variable_hides_an_item_unless_it_is_called() {
        assert_eq!(mentions("fn f() { let rows = 1; rows; other; }"), ["other"]);
        assert_eq!(mentions("fn f() { let rows = rows(); rows; }"), ["rows"]);
    }
}
