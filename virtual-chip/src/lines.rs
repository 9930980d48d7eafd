//! From addresses of the code to lines of the source, by the line tables of the image.

use crate::image::Image;
use addr2line::Context;
use addr2line::gimli::{Dwarf, EndianSlice, LittleEndian};
use object::{Object, ObjectSection};
use std::collections::BTreeMap;

/// A line of the source: path within the repository, and number from 1 on.
pub type Line = (String, u32);

type Slice<'a> = EndianSlice<'a, LittleEndian>;

/// The line tables of an image.
pub struct Lines<'a> {
    context: Context<Slice<'a>>,
    code: (u32, u32),
}

impl<'a> Lines<'a> {
    /// Read them.
    ///
    /// # Panics
    ///
    /// When the image has none that can be read.
    pub fn read(image: &'a Image) -> Self {
        let file = object::File::parse(&*image.elf).expect("was parsed before");
        let section = |name: &str| file.section_by_name(name).and_then(|section| section.data().ok());
        let load = |id: addr2line::gimli::SectionId| -> Result<Slice<'a>, addr2line::gimli::Error> {
            Ok(EndianSlice::new(section(id.name()).unwrap_or_default(), LittleEndian))
        };
        let dwarf = Dwarf::load(load).expect("nothing fails in there");
        Self { context: Context::from_dwarf(dwarf).expect("the image has line tables"), code: image.code() }
    }

    /// The line of an address, for people.
    pub fn place(&self, address: u32) -> String {
        let found = self.context.find_location(address.into()).ok().flatten();
        let line = found.and_then(|location| Some(format!("{}:{}", location.file?, location.line?)));
        line.unwrap_or_else(|| format!("{address:#010x}"))
    }

    /// Every line that is wanted and has code, with the first addresses of its pieces: its own code, and what was inlined
    /// there.
    pub fn with_code(&self, is_wanted: impl Fn(&str) -> bool) -> BTreeMap<Line, Vec<u32>> {
        let (first, len) = self.code;
        let mut lines: BTreeMap<Line, Vec<u32>> = BTreeMap::new();
        let pieces = self.context.find_location_range(first.into(), u64::from(first) + u64::from(len));
        for (address, _, _) in pieces.expect("the line tables can be read") {
            for line in self.chain(address) {
                if is_wanted(&line.0) {
                    lines.entry(line).or_default().push(address as u32);
                }
            }
        }
        lines
    }

    /// The lines of the repository that an address belongs to, from the innermost function that was inlined outwards.
    fn chain(&self, address: u64) -> Vec<Line> {
        let mut frames = self.context.find_frames(address).skip_all_loads().expect("the line tables can be read");
        let mut lines = Vec::new();
        while let Ok(Some(frame)) = frames.next() {
            if let Some((Some(path), Some(line @ 1..))) = frame.location.map(|found| (found.file, found.line)) {
                lines.extend(within_repository(path).map(|path| (path, line)));
            }
        }
        lines
    }
}

/// The compiler writes where it was run, then the path that it was given.
fn within_repository(path: &str) -> Option<String> {
    let at = path.find("src/board/")?;
    Some(path[at..].to_string())
}
