//! What a name means in a module: an item of its file, a module, or what an import brings from elsewhere.

use std::collections::BTreeSet;
use std::path::Path;

use syn::visit::Visit;
use syn::{Item, ItemUse, UseTree, Visibility};

use super::source::{Module, SourceCrate};

/// A name as the segments of its path.
pub(super) type Segments = Vec<String>;

/// What stands behind a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Target<'a> {
    /// An item that this file defines.
    File(&'a Path),
    /// A module of the crate.
    Module(usize),
}

/// One leaf of a `use` tree.
#[derive(Clone, Debug)]
pub(super) struct Import {
    /// What is imported, without `*`.
    pub(super) path: Segments,
    /// The name that it has here; `None` of `*`.
    pub(super) name: Option<String>,
    /// Whether others see it: then it hands a name on and uses none.
    pub(super) is_reexport: bool,
}

/// The names of one module. In Rust one name may be a type, a value and a macro at once: all of them count.
#[derive(Debug, Default)]
struct Names {
    /// Types and traits: they have names inside, which the others have not.
    types: BTreeSet<String>,
    others: BTreeSet<String>,
    imports: Vec<Import>,
}

/// What is looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Sought {
    /// The end of a path.
    Anything,
    /// A step on the way: a module or a type.
    Container,
}

/// The names of a crate.
pub(super) struct Scope<'a> {
    source: &'a SourceCrate,
    names: Vec<Names>,
}

/// Names that are being looked up, so that re-exports in a circle come to an end.
type Pending = BTreeSet<(usize, String, Sought)>;

impl<'a> Scope<'a> {
    pub(super) fn of(source: &'a SourceCrate) -> Self {
        Self { source, names: source.modules.iter().map(Names::of).collect() }
    }

    /// The imports of a module, those within its functions too.
    pub(super) fn imports(&self, module: usize) -> &[Import] {
        &self.names[module].imports
    }

    /// What a path means in a module. Nothing where it leads out of the crate.
    pub(super) fn resolve(&self, module: usize, path: &[String]) -> BTreeSet<Target<'a>> {
        self.follow(module, path, Sought::Anything, &mut Pending::new())
    }

    fn follow(&self, module: usize, path: &[String], sought: Sought, pending: &mut Pending) -> BTreeSet<Target<'a>> {
        let mut targets = BTreeSet::from([Target::Module(module)]);
        for (index, segment) in path.iter().enumerate() {
            let sought = if index + 1 == path.len() { sought } else { Sought::Container };
            let mut step = |target| match (segment.as_str(), target) {
                // A variant, a method or a constant of the item.
                (_, Target::File(_)) => BTreeSet::from([target]),
                ("crate", _) => BTreeSet::from([Target::Module(0)]),
                ("self", _) => BTreeSet::from([target]),
                ("super", Target::Module(here)) => self.parent(here).into_iter().collect(),
                (name, Target::Module(here)) => self.look_up(here, name, sought, pending),
            };
            targets = targets.into_iter().flat_map(&mut step).collect();
        }
        targets
    }

    fn parent(&self, module: usize) -> Option<Target<'a>> {
        self.source.modules[module].parent.map(Target::Module)
    }

    fn look_up(&self, module: usize, name: &str, sought: Sought, pending: &mut Pending) -> BTreeSet<Target<'a>> {
        let key = (module, name.to_string(), sought);
        if !pending.insert(key.clone()) {
            return BTreeSet::new();
        }
        let Module { file, children, .. } = &self.source.modules[module];
        let names = &self.names[module];
        let mut targets = BTreeSet::new();
        if names.types.contains(name) || sought == Sought::Anything && names.others.contains(name) {
            targets.insert(Target::File(file));
        }
        targets.extend(children.iter().filter(|(child, _)| child == name).map(|&(_, child)| Target::Module(child)));
        for import in names.imports.iter().filter(|import| import.name.as_deref() == Some(name)) {
            targets.extend(self.follow(module, &import.path, sought, pending));
        }
        if targets.is_empty() {
            for import in names.imports.iter().filter(|import| import.name.is_none()) {
                let path: Segments = import.path.iter().cloned().chain([name.to_string()]).collect();
                targets.extend(self.follow(module, &path, sought, pending));
            }
        }
        pending.remove(&key);
        targets
    }
}

impl Names {
    fn of(module: &Module) -> Self {
        let mut names = Self::default();
        for item in &module.items {
            names.types.extend(defined_type(item));
            names.others.extend(defined_other(item));
            names.visit_item(item);
        }
        names
    }
}

impl<'ast> Visit<'ast> for Names {
    fn visit_item_use(&mut self, item: &'ast ItemUse) {
        if item.leading_colon.is_none() {
            let is_reexport = !matches!(item.vis, Visibility::Inherited);
            leaves(&item.tree, &mut Vec::new(), is_reexport, &mut self.imports);
        }
    }

    fn visit_item_mod(&mut self, _: &'ast syn::ItemMod) {}
}

fn defined_type(item: &Item) -> Option<String> {
    let name = match item {
        Item::Enum(item) => &item.ident,
        Item::Struct(item) => &item.ident,
        Item::Trait(item) => &item.ident,
        Item::TraitAlias(item) => &item.ident,
        Item::Type(item) => &item.ident,
        Item::Union(item) => &item.ident,
        _ => return None,
    };
    Some(name.to_string())
}

fn defined_other(item: &Item) -> Vec<String> {
    let name = match item {
        Item::Const(item) => Some(&item.ident),
        Item::Fn(item) => Some(&item.sig.ident),
        Item::Static(item) => Some(&item.ident),
        Item::Macro(item) => item.ident.as_ref(),
        Item::ForeignMod(block) => return block.items.iter().filter_map(foreign).collect(),
        _ => None,
    };
    name.iter().map(ToString::to_string).collect()
}

fn foreign(item: &syn::ForeignItem) -> Option<String> {
    match item {
        syn::ForeignItem::Fn(item) => Some(item.sig.ident.to_string()),
        syn::ForeignItem::Static(item) => Some(item.ident.to_string()),
        _ => None,
    }
}

fn leaves(tree: &UseTree, path: &mut Segments, is_reexport: bool, imports: &mut Vec<Import>) {
    let mut leaf = |path: Segments, name| imports.push(Import { path, name, is_reexport });
    match tree {
        UseTree::Path(step) => {
            path.push(step.ident.to_string());
            leaves(&step.tree, path, is_reexport, imports);
            path.pop();
        }
        UseTree::Group(group) => group.items.iter().for_each(|tree| leaves(tree, path, is_reexport, imports)),
        UseTree::Glob(_) => leaf(path.clone(), None),
        // `use a::b::{self}` imports `b`.
        UseTree::Name(name) if name.ident == "self" => leaf(path.clone(), path.last().cloned()),
        UseTree::Rename(name) if name.ident == "self" => leaf(path.clone(), Some(name.rename.to_string())),
        UseTree::Name(name) => leaf(joined(path, &name.ident), Some(name.ident.to_string())),
        UseTree::Rename(name) => leaf(joined(path, &name.ident), Some(name.rename.to_string())),
    }
}

fn joined(path: &[String], last: &syn::Ident) -> Segments {
    path.iter().cloned().chain([last.to_string()]).collect()
}
