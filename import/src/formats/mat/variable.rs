//! Variables of a MATLAB file: arrays of numbers, texts, structs.

use super::super::fields::texts;
use super::super::memory::Budget;
use super::element::{Element, Elements, Fault, Kind, Order};
use crate::source::Values;

/// Structs within structs: deeper ones hold no readings.
const DEEPEST: usize = 4;
/// Classes of arrays (table 3 of the format).
const STRUCT: u32 = 2;
const CHARACTERS: u32 = 4;
const NUMBERS: std::ops::RangeInclusive<u32> = 6..=15;

/// A variable, or a field of a struct.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Variable {
    pub(super) name: String,
    /// The first is that along which values are neighbours.
    pub(super) sizes: Vec<usize>,
    pub(super) content: Content,
}

/// What a variable holds.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Content {
    /// Numbers, or texts of one row each.
    Values(Values),
    /// The fields of each struct of an array of them.
    Structs(Vec<Vec<Variable>>),
    /// Cells, objects, sparse matrices: no columns.
    Other,
}

/// All variables of a file behind its header.
pub(super) fn all(body: &[u8], order: Order, budget: &mut Budget) -> Result<Vec<Variable>, Fault> {
    let mut elements = Elements::new(body, order);
    let mut variables = Vec::new();
    while !elements.is_empty() {
        let element = elements.next("a variable")?;
        if element.kind == Kind::Compressed {
            let bytes = element.inflated(budget)?;
            let inner = Elements::new(&bytes, order).next("a compressed variable")?;
            variables.push(variable(inner, order, budget, DEEPEST)?);
        } else {
            variables.push(variable(element, order, budget, DEEPEST)?);
        }
    }
    Ok(variables)
}

fn variable(matrix: Element<'_>, order: Order, budget: &mut Budget, deeper: usize) -> Result<Variable, Fault> {
    if matrix.kind != Kind::Matrix {
        return Err(Fault::Cut("a variable"));
    }
    if matrix.bytes.is_empty() {
        return Ok(Variable { name: String::new(), sizes: vec![0], content: Content::Other });
    }
    let mut elements = Elements::new(matrix.bytes, order);
    let flags = elements.next("the kind of a variable")?.numbers(order, budget)?;
    let class = flags.first().map_or(0, |flags| *flags as u32 & 0xff);
    let sizes = elements.next("the size of a variable")?.numbers(order, budget)?;
    let sizes: Vec<usize> = sizes.into_iter().map(|size| size as usize).collect();
    let name = text(elements.next("the name of a variable")?.bytes);
    let count = sizes.iter().fold(1_usize, |count, size| count.saturating_mul(*size));
    let content = match class {
        STRUCT if deeper > 0 => Content::Structs(structs(&mut elements, count, order, budget, deeper - 1)?),
        CHARACTERS => rows_of_text(&mut elements, &sizes, order, budget)?,
        class if NUMBERS.contains(&class) => numbers(&mut elements, count, order, budget)?,
        _ => Content::Other,
    };
    let sizes = if class == CHARACTERS { sizes.into_iter().take(1).collect() } else { sizes };
    Ok(Variable { name, sizes, content })
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).trim_matches(['\0', ' ']).to_owned()
}

/// The imaginary part of complex numbers, which would follow, is no reading.
fn numbers(elements: &mut Elements<'_>, count: usize, order: Order, budget: &mut Budget) -> Result<Content, Fault> {
    if count == 0 {
        return Ok(Content::Other);
    }
    let numbers = elements.next("the numbers of a variable")?.numbers(order, budget)?;
    if numbers.len() == count { Ok(Content::Values(Values::Numbers(numbers))) } else { Err(Fault::Cut("its numbers")) }
}

/// A matrix of characters has a text in each row, filled with blanks.
fn rows_of_text(
    elements: &mut Elements<'_>,
    sizes: &[usize],
    order: Order,
    budget: &mut Budget,
) -> Result<Content, Fault> {
    let &[rows, width] = sizes else { return Ok(Content::Other) };
    if rows == 0 || width == 0 {
        return Ok(Content::Other);
    }
    let element = elements.next("a text")?;
    let codes = element.numbers(order, budget)?;
    if codes.len() != rows.saturating_mul(width) {
        // Texts in UTF-8 with letters of several bytes: no row of a table is that.
        return Ok(Content::Other);
    }
    budget.take(codes.len(), 4)?;
    let letter = |code: &f64| char::from_u32(*code as u32).unwrap_or(char::REPLACEMENT_CHARACTER);
    let row = |row: usize| codes.iter().skip(row).step_by(rows).map(letter).collect::<String>();
    Ok(Content::Values(texts((0..rows).map(row))))
}

fn structs(
    elements: &mut Elements<'_>,
    count: usize,
    order: Order,
    budget: &mut Budget,
    deeper: usize,
) -> Result<Vec<Vec<Variable>>, Fault> {
    let width = elements.next("a struct")?.numbers(order, budget)?.first().map_or(0, |width| *width as usize);
    let names = elements.next("the names of a struct")?.bytes;
    if width == 0 || names.is_empty() {
        return Ok(Vec::new());
    }
    let names: Vec<String> = names.chunks(width).map(text).collect();
    let mut structs = Vec::new();
    for _ in 0..count {
        let field = |name: &String| {
            let matrix = elements.next("a field of a struct")?;
            Ok(Variable { name: name.clone(), ..variable(matrix, order, budget, deeper)? })
        };
        structs.push(names.iter().map(field).collect::<Result<Vec<_>, Fault>>()?);
    }
    Ok(structs)
}
