//! Several files to one recording: pieces of one log after each other, or sensors and navigation side by side, by time.

use towmag_recording::Column;

use crate::between::led;
use crate::columns::free_name;
use crate::draft::{DraftColumn, DraftValues};
use crate::error::ImportError;
use crate::finding::Finding;
use crate::part::Part;
use crate::source::FindingKind;
use crate::stamp::DAY_S;

/// One part of all. The one with scalar and fluxgate leads, else the one with either; of equals the longest.
///
/// # Errors
///
/// When their times have nothing in common.
pub(crate) fn join(mut parts: Vec<Part>) -> Result<Part, ImportError> {
    parts.sort_by_key(|part| {
        let sensors = usize::from(part.has(Column::Scalar)) + usize::from(part.has(Column::FluxX));
        std::cmp::Reverse((sensors * usize::from(!part.is_slow()), sensors, part.draft.len()))
    });
    let mut rest = parts.into_iter();
    let mut main = rest.next().ok_or_else(|| ImportError::Usage("name a file to import".into()))?;
    for part in rest {
        if is_next_piece(&main, &part) {
            append(&mut main, part);
        } else {
            add(&mut main, part)?;
        }
    }
    Ok(main)
}

/// The same columns, at other times.
fn is_next_piece(main: &Part, other: &Part) -> bool {
    let names = |part: &Part| part.draft.columns.iter().map(|column| column.name.clone()).collect::<Vec<_>>();
    let (Some((a, b)), Some((c, d))) = (span(main), span(other)) else { return false };
    names(main) == names(other) && (b < c || d < a)
}

fn span(part: &Part) -> Option<(f64, f64)> {
    Some((*part.draft.time_s.first()?, *part.draft.time_s.last()?))
}

fn append(main: &mut Part, other: Part) {
    let is_before = span(&other).zip(span(main)).is_some_and(|((begin, _), (first, _))| begin < first);
    let (mut first, second) =
        if is_before { (other.draft, main.draft.clone()) } else { (main.draft.clone(), other.draft) };
    first.time_s.extend(second.time_s);
    first.invalid.extend(second.invalid);
    for (column, more) in first.columns.iter_mut().zip(second.columns) {
        match (&mut column.values, more.values) {
            (DraftValues::Numbers(numbers), DraftValues::Numbers(more)) => numbers.extend(more),
            (DraftValues::Labels(labels), DraftValues::Labels(more)) => labels.extend(more),
            (DraftValues::Numbers(numbers), DraftValues::Labels(more)) => {
                numbers.extend(std::iter::repeat_n(f64::NAN, more.len()));
            }
            (DraftValues::Labels(labels), DraftValues::Numbers(more)) => {
                labels.extend(std::iter::repeat_n("".into(), more.len()));
            }
        }
    }
    main.draft = first;
    main.rows_in += other.rows_in;
    main.rows_left_out += other.rows_left_out;
    main.findings.extend(other.findings);
    main.findings.push(Finding::new(
        FindingKind::Order,
        format!("{} goes on with the same columns and was appended", other.file),
    ));
}

/// The columns of another file at the times of this one.
fn add(main: &mut Part, mut other: Part) -> Result<(), ImportError> {
    align_days(main, &mut other);
    let overlap = span(main).zip(span(&other)).filter(|((a, b), (c, d))| a.max(*c) < b.min(*d));
    if overlap.is_none() {
        let show =
            |part: &Part| span(part).map_or("no rows".into(), |(begin, end)| format!("{begin:.1} to {end:.1} s"));
        let what = format!(
            "has no time in common with {} ({} against {}): give the date of the one that has none with --date, or import them apart",
            main.file,
            show(&other),
            show(main)
        );
        return Err(ImportError::file(&other.file, what));
    }
    let is_base = main.has(Column::Scalar) && other.has(Column::Scalar) && other.is_slow();
    let mut added = Vec::new();
    for column in std::mem::take(&mut other.draft.columns) {
        let known = match column.known {
            Some(Column::Scalar) if is_base => Some(Column::Base),
            known => known,
        };
        // Sensors of a base station are none of the body's.
        if is_base && known.is_none_or(|known| known != Column::Base) {
            continue;
        }
        if known.is_some_and(|known| main.has(known)) {
            continue;
        }
        main.draft.columns.retain(|there| known.is_none() || there.known != known);
        let name = match known {
            Some(known) => known.name().to_string(),
            None if towmag_recording::load_of(&column.name).is_some() => column.name.clone(),
            None => free_name(&column.name, &main.draft.columns),
        };
        let values = at_times(&main.draft.time_s, &other.draft.time_s, &column, known);
        added.push(name.clone());
        main.columns.insert(name.clone(), format!("{}: {}", other.file, column.name));
        main.draft.columns.push(DraftColumn { name, known, values, is_made: true });
    }
    // What only told of the other file's rate or lack is settled by what it gives.
    other.findings.retain(|finding| !matches!(finding.kind, FindingKind::Rate | FindingKind::Missing));
    main.findings.extend(other.findings);
    let text = format!("{} was merged by time: {}", other.file, added.join(", "));
    main.findings.push(Finding::new(FindingKind::Choice, text));
    Ok(())
}

/// A clock without a date beside one with it: on the day on which they overlap.
fn align_days(main: &mut Part, other: &mut Part) {
    let shift = |dated: &Part, undated: &Part| -> Option<f64> {
        let ((begin, end), (first, last)) = (span(dated)?, span(undated)?);
        let day = (begin / DAY_S).floor();
        [0.0, -1.0, 1.0]
            .map(|more| (day + more) * DAY_S)
            .into_iter()
            .find(|shift| first + shift < end && last + shift > begin)
    };
    let (dated, undated) = match (main.draft.is_utc, other.draft.is_utc) {
        (true, false) => (&*main, &mut *other),
        (false, true) => (&*other, &mut *main),
        _ => return,
    };
    let of_a_day = span(undated).is_some_and(|(begin, _)| (0.0..2.0 * DAY_S).contains(&begin));
    if let Some(shift_s) = shift(dated, undated).filter(|_| of_a_day) {
        undated.draft.time_s.iter_mut().for_each(|time_s| *time_s += shift_s);
        undated.draft.is_utc = true;
        undated.draft.is_clock = true;
    }
}

fn at_times(times: &[f64], source_s: &[f64], column: &DraftColumn, known: Option<Column>) -> DraftValues {
    let is_angle = matches!(known, Some(Column::Heading | Column::Roll));
    match &column.values {
        DraftValues::Labels(labels) => {
            let label = |time_s: &f64| {
                let before = source_s.partition_point(|source| source <= time_s).checked_sub(1);
                before.map_or("".into(), |row| labels[row].clone())
            };
            DraftValues::Labels(times.iter().map(label).collect())
        }
        DraftValues::Numbers(numbers) => DraftValues::Numbers(led(times, source_s, numbers, is_angle)),
    }
}
