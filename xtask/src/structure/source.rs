//! A crate as its modules, parsed. What is there for tests alone is left out.

use std::path::{Path, PathBuf};

use syn::{Attribute, Item};

use super::cfg_test::is_for_tests;

/// A module: a file's own, or one in braces within a file.
pub struct Module {
    /// The file that it stands in.
    pub file: PathBuf,
    /// The module that declares it; `None` of the crate's root.
    pub parent: Option<usize>,
    /// Names and numbers of the modules that it declares.
    pub children: Vec<(String, usize)>,
    /// Everything else in it.
    pub items: Vec<Item>,
}

/// All modules of a crate; number 0 is its root.
#[derive(Default)]
pub struct SourceCrate {
    /// In the order of their declaration.
    pub modules: Vec<Module>,
}

/// Text of a source file, or `None` where there is no such file.
pub(super) type Read<'a> = &'a dyn Fn(&Path) -> Option<String>;

/// The file as it is on the disk.
pub fn on_disk(path: &Path) -> Option<String> {
    std::fs::read_to_string(path).ok()
}

impl SourceCrate {
    /// The crate that begins at a file. Panics, naming the file, where one is missing or cannot be parsed.
    pub fn parse(root: &Path, read: Read<'_>) -> Self {
        let mut parsed = Self::default();
        let folder = root.parent().unwrap_or(Path::new("")).to_path_buf();
        parsed.add(root.to_path_buf(), &folder, None, items(root, read), read);
        parsed
    }

    /// Add a module and those that it declares; `folder` is where their files lie.
    fn add(&mut self, file: PathBuf, folder: &Path, parent: Option<usize>, items: Vec<Item>, read: Read<'_>) -> usize {
        let module = self.modules.len();
        self.modules.push(Module { file: file.clone(), parent, children: Vec::new(), items: Vec::new() });
        for item in items {
            let Item::Mod(declared) = item else {
                if !is_for_tests(attributes(&item)) {
                    self.modules[module].items.push(item);
                }
                continue;
            };
            if is_for_tests(&declared.attrs) {
                continue;
            }
            let name = declared.ident.to_string();
            let inside = folder.join(&name);
            let child = match declared.content {
                Some((_, items)) => self.add(file.clone(), &inside, Some(module), items, read),
                None => {
                    let path = file_of(&declared.attrs, folder, &name, &file, read);
                    let items = self::items(&path, read);
                    self.add(path, &inside, Some(module), items, read)
                }
            };
            self.modules[module].children.push((name, child));
        }
        module
    }
}

/// The file of `mod name;`.
fn file_of(attributes: &[Attribute], folder: &Path, name: &str, declared_in: &Path, read: Read<'_>) -> PathBuf {
    if let Some(path) = attributes.iter().find_map(path_attribute) {
        return declared_in.parent().unwrap_or(Path::new("")).join(path);
    }
    let candidates = [folder.join(format!("{name}.rs")), folder.join(name).join("mod.rs")];
    let found = candidates.into_iter().find(|path| read(path).is_some());
    found.unwrap_or_else(|| panic!("{}: no file for `mod {name};`", declared_in.display()))
}

/// What `#[path = "..."]` says.
fn path_attribute(attribute: &Attribute) -> Option<String> {
    let value = &attribute.meta.require_name_value().ok().filter(|pair| pair.path.is_ident("path"))?.value;
    match value {
        syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Str(text), .. }) => Some(text.value()),
        _ => None,
    }
}

fn items(path: &Path, read: Read<'_>) -> Vec<Item> {
    let text = read(path).unwrap_or_else(|| panic!("{}: no such file", path.display()));
    syn::parse_file(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display())).items
}

/// The attributes of an item that can have a condition.
pub(super) fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Const(item) => &item.attrs,
        Item::Enum(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        Item::Macro(item) => &item.attrs,
        Item::Mod(item) => &item.attrs,
        Item::Static(item) => &item.attrs,
        Item::Struct(item) => &item.attrs,
        Item::Trait(item) => &item.attrs,
        Item::Type(item) => &item.attrs,
        Item::Union(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        _ => &[],
    }
}
