//! Colours of methods and sensors: those of Okabe and Ito (2008) that stand out on white, apart to colour-blind eyes as well.

use plotly::common::DashType;

use crate::run::MethodResult;

/// Colour of what there was before compensation.
pub(in crate::report) const BEFORE: &str = "#767676";

/// Colours of the two sensors.
pub(in crate::report) const SCALAR: &str = COLOURS[0];
/// See [`SCALAR`].
pub(in crate::report) const FLUXGATE: &str = COLOURS[1];

const COLOURS: [&str; 5] = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#000000"];

/// Places of the known methods, so that a method looks the same on every page.
const KNOWN: [(&str, usize); 5] = [("adaptive", 0), ("saddle-point", 1), ("rls", 2), ("fixed", 3), ("none", 4)];

/// Colour and dash of one method, the same in every chart.
#[derive(Clone, Debug)]
pub(in crate::report) struct Look {
    pub(in crate::report) colour: &'static str,
    pub(in crate::report) dash: DashType,
}

/// One look per method. Unknown names take the colours that are left; beyond five methods the lines are dashed.
pub(in crate::report) fn looks(methods: &[MethodResult]) -> Vec<Look> {
    let known = |method: &MethodResult| KNOWN.iter().find(|(name, _)| *name == method.name).map(|(_, place)| *place);
    let taken: Vec<usize> = methods.iter().filter_map(known).collect();
    let mut free = (0..).filter(|place| !taken.contains(place));
    let place = |method| known(method).or_else(|| free.next()).unwrap_or(0);
    let look = |place: usize| Look {
        colour: COLOURS[place % COLOURS.len()],
        dash: if place < COLOURS.len() { DashType::Solid } else { DashType::Dash },
    };
    methods.iter().map(place).map(look).collect()
}
