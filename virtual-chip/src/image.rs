//! The image that is flashed.

use object::read::elf::ProgramHeader;
use object::{Object, ObjectSection, ObjectSegment, ObjectSymbol};
use std::path::{Path, PathBuf};

/// First address of the flash.
pub const FLASH_BASE: u32 = 0x0800_0000;

/// What `cargo fw` makes.
pub struct Image {
    /// The whole file, for its line tables.
    pub elf: Vec<u8>,
    /// Content of the flash from its first address on.
    pub flash: Vec<u8>,
}

impl Image {
    /// Read it from where `cargo fw` puts it.
    ///
    /// # Panics
    ///
    /// When it is not there or is no image: the tests cannot go on.
    pub fn load() -> Self {
        let path = path();
        let elf =
            std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}: run `cargo fw` first", path.display()));
        let flash = flash(&elf).unwrap_or_else(|error| panic!("{}: {error}: run `cargo fw` again", path.display()));
        Self { elf, flash }
    }

    /// Address of the first symbol whose name has this part.
    ///
    /// # Panics
    ///
    /// When there is none of this name.
    pub fn symbol_like(&self, name: &str) -> u32 {
        let file = object::File::parse(&*self.elf).expect("was parsed before");
        let symbol = file.symbols().find(|symbol| symbol.name().is_ok_and(|full| full.contains(name)));
        symbol.unwrap_or_else(|| panic!("the image has no symbol {name}")).address() as u32
    }

    /// Address and length of the code.
    pub fn code(&self) -> (u32, u32) {
        let file = object::File::parse(&*self.elf).expect("was parsed before");
        let text = file.section_by_name(".text").expect("an image has code");
        (text.address() as u32, text.size() as u32)
    }
}

fn path() -> PathBuf {
    let target = std::env::var_os("CARGO_TARGET_DIR").map(PathBuf::from);
    let target = target.unwrap_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../target"));
    target.join("thumbv7em-none-eabihf/firmware/firmware")
}

/// What the segments put into the flash; those of RAM lie there with what their statics start with.
fn flash(elf: &[u8]) -> object::Result<Vec<u8>> {
    let file = object::read::elf::ElfFile32::<object::Endianness>::parse(elf)?;
    let mut flash = Vec::new();
    for segment in file.segments() {
        let data = segment.data()?;
        let at = segment.elf_program_header().p_paddr(file.endian()).checked_sub(FLASH_BASE);
        let Some(at) = at.filter(|_| !data.is_empty()) else { continue };
        let end = at as usize + data.len();
        flash.resize(flash.len().max(end), 0xff);
        flash[at as usize..end].copy_from_slice(data);
    }
    Ok(flash)
}
