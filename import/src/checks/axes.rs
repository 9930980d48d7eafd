//! Which axis is which: by a heading where there is one, else by which axis stands still while the body turns.

use towmag_recording::Column;

use super::earth::at_the_track;
use super::heading;
use super::statistics::{moments, usable};
use crate::draft::Draft;
use crate::finding::Finding;
use crate::profile::Axis;
use crate::source::FindingKind;

/// The body turns when two axes vary by this part of the field.
const TURNS: f64 = 0.12;
/// The third varies by at most this part of either of the two.
const STEADY: f64 = 0.4;

/// Axes that are not forward, starboard and down.
pub(super) fn check(draft: &Draft) -> Option<Finding> {
    let flux = draft.flux()?;
    let no_scalar = vec![0.0; draft.len()];
    let rows = usable(draft, draft.numbers(Column::Scalar).unwrap_or(&no_scalar), &flux);
    if rows.len() < 100 {
        return None;
    }
    let earth = at_the_track(draft);
    if let Some(headings) = draft.numbers(Column::Heading)
        && let Some(found) = heading::axes(&flux, headings, &rows)
    {
        return by_heading(found, &flux, &rows, earth.map(|earth| earth.down_nt));
    }
    by_steadiness(&flux, &rows, earth.map(|earth| earth.down_nt))
}

/// Headings tell forward and starboard. Down is where the field points: in the northern half, unless the place is known.
fn by_heading(found: heading::Found, flux: &[&[f64]; 3], rows: &[usize], down_nt: Option<f64>) -> Option<Finding> {
    let [forward, starboard, vertical] = found.axes;
    let mean = moments(rows.iter().map(|&row| flux[vertical.of][row])).0;
    let is_turned = (mean < 0.0) != down_nt.is_some_and(|down_nt| down_nt < 0.0);
    let axes = [forward, starboard, Axis { of: vertical.of, is_turned }];
    if axes.iter().enumerate().all(|(at, axis)| axis.of == at && !axis.is_turned) {
        return None;
    }
    let is_left_handed = is_turned != turned_for_right_hand(forward, starboard, vertical.of);
    let half = if down_nt.is_none() { ", unless this is south of the magnetic equator" } else { "" };
    let (kind, what) = if is_left_handed {
        (FindingKind::Handedness, format!("the axes are left-handed{half}"))
    } else {
        (FindingKind::Axes, "the axes are not forward, starboard, down".to_string())
    };
    let text = format!("{what}: by the heading column forward, starboard, down are {}", names(axes));
    Some(Finding::warning(kind, text).with(format!("--axes {}", names(axes))))
}

fn by_steadiness(flux: &[&[f64]; 3], rows: &[usize], down_nt: Option<f64>) -> Option<Finding> {
    let moments = flux.map(|axis| moments(rows.iter().map(|&row| axis[row])));
    let total = moments.iter().map(|(mean, std)| mean * mean + std * std).sum::<f64>().sqrt();
    let steadiest = (0..3).min_by(|&a, &b| moments[a].1.total_cmp(&moments[b].1))?;
    let others = || (0..3).filter(|axis| *axis != steadiest).map(|axis| moments[axis].1);
    let turns = others().all(|std| std > TURNS * total && moments[steadiest].1 < STEADY * std);
    if !turns {
        return None;
    }
    let mean = moments[steadiest].0;
    let is_turned = (mean < 0.0) != down_nt.is_some_and(|down_nt| down_nt < 0.0);
    if steadiest == 2 {
        // Without a place, a field that points up may be the southern half's: nothing in the recording tells.
        let text = "flux_z_nT is against the Earth's field throughout: z points up";
        let finding = || Finding::warning(FindingKind::Axes, text).with("--axes x,-y,-z");
        return (down_nt.is_some() && is_turned).then(finding);
    }
    let forward = Axis { of: (steadiest + 1) % 3, is_turned: false };
    let down = Axis { of: steadiest, is_turned };
    let starboard = Axis { of: (steadiest + 2) % 3, is_turned };
    let axes = [forward, starboard, down];
    let text = format!(
        "the axes are not forward, starboard, down: {} carries the vertical field, as it stays while the others turn; \
         which of the others is forward only a heading would tell; right-handed would be {}",
        Column::FLUX[steadiest].name(),
        names(axes)
    );
    Some(Finding::warning(FindingKind::Axes, text).with(format!("--axes {}", names(axes))))
}

/// Whether the down axis must be turned for forward x starboard = down.
fn turned_for_right_hand(forward: Axis, starboard: Axis, down: usize) -> bool {
    let even = (forward.of + 1) % 3 == starboard.of && (starboard.of + 1) % 3 == down;
    let signs = forward.is_turned != starboard.is_turned;
    even == signs
}

fn names(axes: [Axis; 3]) -> String {
    axes.map(String::from).join(",")
}
