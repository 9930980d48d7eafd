//! Functions of an image, and which calls which.

use std::collections::{BTreeMap, BTreeSet};

use anyhow::{Context, bail};
use object::elf::{R_ARM_ABS32, R_ARM_THM_JUMP19, R_ARM_THM_JUMP24, R_ARM_THM_PC22};
use object::elf::{R_ARM_THM_MOVT_ABS, R_ARM_THM_MOVW_ABS_NC};
use object::read::elf::{ElfFile32, SectionHeader};
use object::{Endianness, Object, ObjectSection, ObjectSymbol, RelocationFlags, RelocationTarget, SymbolKind};

use super::thumb::{self, Code};

/// A function of the image, by its place in [`Image::functions`].
pub(super) type Number = usize;

/// A function.
#[derive(Debug)]
pub(super) struct Function {
    /// Demangled, without the hash.
    pub(super) name: String,
    /// What its code does to the stack.
    pub(super) code: Code,
    /// What it calls by name, also as its last act.
    pub(super) calls: BTreeSet<Number>,
}

/// All functions, in the order of their addresses.
#[derive(Debug)]
pub(super) struct Image {
    pub(super) functions: Vec<Function>,
    /// The room that the memory map leaves for the stack.
    pub(super) stack_bytes: u32,
    /// Those whose address is stored or passed somewhere: what an indirect call may lead to.
    pub(super) address_taken: BTreeSet<Number>,
    /// Number of the function that begins at an address.
    starts: BTreeMap<u64, (Number, u64)>,
}

impl Image {
    /// Read an image that was linked with `--emit-relocs`.
    pub(super) fn read(bytes: &[u8]) -> anyhow::Result<Self> {
        let file = ElfFile32::<Endianness>::parse(bytes)?;
        let address = |name: &str| {
            let symbol = file.symbols().find(|symbol| symbol.name() == Ok(name));
            symbol.map(|symbol| symbol.address()).with_context(|| format!("no symbol {name}"))
        };
        let stack_bytes = u32::try_from(address("_stack_start")? - address("_stack_end")?)?;
        let (address_taken, starts) = (BTreeSet::new(), BTreeMap::new());
        let mut image = Self { functions: Vec::new(), stack_bytes, address_taken, starts };
        image.take_functions(&file)?;
        let mut edges = 0;
        for section in file.sections() {
            let name = section.name()?;
            if name.starts_with(".debug") || name == ".vector_table" {
                continue;
            }
            edges += image.take_relocations(&file, &section)?;
        }
        if edges == 0 {
            bail!("the image has no relocations: link it with --emit-relocs");
        }
        Ok(image)
    }

    fn take_functions(&mut self, file: &ElfFile32<'_, Endianness>) -> anyhow::Result<()> {
        let text = file.section_by_name(".text").context("no section .text")?;
        let (bytes, base) = (text.data()?, text.address());
        let mut found: BTreeMap<u64, (u64, String)> = BTreeMap::new();
        // What lies between the code of a function and is no code: the assembler's `$d`, up to the next `$t`.
        let mut marks: BTreeMap<u64, bool> = BTreeMap::new();
        for symbol in file.symbols() {
            let (address, name) = (symbol.address() & !1, symbol.name()?);
            match name.split('.').next() {
                Some("$d") => _ = marks.insert(address, false),
                Some("$t") => _ = marks.insert(address, true),
                _ if symbol.kind() == SymbolKind::Text && symbol.size() > 0 => {
                    found.entry(address).or_insert_with(|| (symbol.size(), plain(name)));
                }
                _ => {}
            }
        }
        for (address, (size, name)) in found {
            let begin = usize::try_from(address.checked_sub(base).context("a function outside .text")?)?;
            let code = bytes.get(begin..begin + usize::try_from(size)?).context("a function outside .text")?;
            let is_code = |offset: usize| marks.range(..=address + offset as u64).next_back().is_none_or(|(_, is)| *is);
            self.starts.insert(address, (self.functions.len(), size));
            self.functions.push(Function { name, code: thumb::read(code, is_code), calls: BTreeSet::new() });
        }
        Ok(())
    }

    /// Calls and addresses in a section; how many there were.
    fn take_relocations<'d, S>(&mut self, file: &ElfFile32<'d, Endianness>, section: &S) -> anyhow::Result<u32>
    where
        S: ObjectSection<'d>,
    {
        let mut count = 0;
        for (place, relocation) in relocations(file, section.index())? {
            let RelocationFlags::Elf { r_type } = relocation.1 else { continue };
            let RelocationTarget::Symbol(index) = relocation.0 else { continue };
            let symbol = file.symbol_by_index(index)?;
            let Some(&(target, _)) = self.starts.get(&(symbol.address() & !1)) else { continue };
            if symbol.kind() != SymbolKind::Text {
                continue;
            }
            count += 1;
            let caller = self.function_at(place);
            match (r_type, caller) {
                (R_ARM_THM_PC22 | R_ARM_THM_JUMP24 | R_ARM_THM_JUMP19, Some(caller)) => {
                    self.functions[caller].calls.insert(target);
                }
                (R_ARM_ABS32 | R_ARM_THM_MOVW_ABS_NC | R_ARM_THM_MOVT_ABS, _) => _ = self.address_taken.insert(target),
                _ => bail!("relocation {r_type} at {place:#x} is not understood"),
            }
        }
        Ok(count)
    }

    /// The function that an address lies in.
    fn function_at(&self, address: u64) -> Option<Number> {
        let (start, (number, size)) = self.starts.range(..=address).next_back()?;
        (address < start + size).then_some(*number)
    }

    /// The first function of this name.
    pub(super) fn named(&self, name: &str) -> Option<Number> {
        self.functions.iter().position(|function| function.name == name)
    }
}

type Relocation = (RelocationTarget, RelocationFlags);

/// Relocations that belong to a section. In an image they are sections of their own, which say whose they are.
fn relocations(file: &ElfFile32<'_, Endianness>, of: object::SectionIndex) -> anyhow::Result<Vec<(u64, Relocation)>> {
    let endian = file.endian();
    let mut all = Vec::new();
    for header in file.elf_section_table().iter() {
        if header.sh_info(endian) as usize != of.0 {
            continue;
        }
        let Some((entries, _)) = header.rel(endian, file.data())? else { continue };
        for entry in entries {
            let symbol = object::SymbolIndex(entry.r_sym(endian) as usize);
            let flags = RelocationFlags::Elf { r_type: entry.r_type(endian) };
            all.push((u64::from(entry.r_offset.get(endian)), (RelocationTarget::Symbol(symbol), flags)));
        }
    }
    Ok(all)
}

/// A name as it is in the source, without the parameters of its types' parameters.
fn plain(name: &str) -> String {
    let (mut depth, mut plain) = (0_i32, String::new());
    for character in format!("{:#}", rustc_demangle::demangle(name)).chars() {
        depth += i32::from(character == '<');
        if depth < 2 {
            plain.push(character);
        }
        // The arrow of a function's type closes nothing.
        depth -= i32::from(character == '>' && !plain.ends_with("->"));
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::plain;

    #[test]
    fn names_are_short_and_stay_apart() {
        assert_eq!(plain("_ZN6towmag5store4scan4read17h0123456789abcdefE"), "towmag::store::scan::read");
        assert_eq!(plain("drop_in_place<a::Volume<b::Card<c::Bus>,d::Date>>"), "drop_in_place<a::Volume>");
        assert_eq!(plain("<a::B<C> as d::E>::f"), "<a::B as d::E>::f");
        assert_eq!(plain("f<fn() -> X<u8>>::g"), "f<fn() -> X>::g");
    }
}
