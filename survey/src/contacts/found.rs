//! What is found in a recording, and on which way.

use rayon::prelude::*;

use super::dipole::Dipole;
use super::levelled::{Levelled, Options, RATE_HZ, WayBy};
use super::noise::Noise;
use super::pass::{Pass, pass};
use super::search::Search;
use super::way::Way;

/// Of a dipole on a straight way: place, distance and three amplitudes.
const DIPOLE_PARAMETERS: f64 = 5.0;

/// What was found in a recording.
#[derive(Clone, Debug)]
pub struct Found {
    /// The contacts, in order of time.
    pub passes: Vec<Pass>,
    /// All candidates, the weaker ones too: a search of another level of the same rows begins with them.
    pub candidates: Vec<Dipole>,
    /// Their anomalies, nT a row.
    pub anomaly_nt: Vec<f64>,
    /// The noise that they were told from.
    pub noise: Noise,
    /// What a contact has to explain, twice the logarithm of a likelihood ratio.
    pub threshold: f64,
    /// What told the way.
    pub way_by: WayBy,
}

impl Found {
    /// How well noise and candidates describe the recording, less is better: Akaike's criterion a row, but for what is the same for every
    /// description (Akaike 1974). Of the likelihood of Gaussian noise of a spectrum that is its own, the mean logarithm of the density is
    /// what differs (Whittle 1953).
    pub(crate) fn criterion(&self) -> f64 {
        let parameters = DIPOLE_PARAMETERS * self.candidates.len() as f64;
        self.noise.mean_ln_density() + 2.0 * parameters / (self.noise.hours() * 3600.0 * RATE_HZ)
    }
}

/// The contacts of a recording.
pub fn find(levelled: &Levelled<'_>, options: &Options) -> Found {
    found(Search::new(levelled, *options))
}

/// The contacts in another level of the same rows, from those of the one before on; on the way that leaves less of them.
pub(crate) fn find_again(levelled: &Levelled<'_>, options: &Options, before: &Found) -> Found {
    let (by_positions, by_heading) = (Way::by_positions(levelled), Way::by_heading(levelled));
    let own = by_heading.as_ref().filter(|_| before.way_by == WayBy::Heading).unwrap_or(&by_positions);
    let begun = |way_by: WayBy, way: &Way| {
        let candidates: Vec<Dipole> = before.candidates.iter().map(|dipole| way.taken_over(dipole, own)).collect();
        let mut search = Search::on(way.clone(), levelled, Options { way_by, ..*options });
        search.begin_with(&candidates);
        search
    };
    let (by_positions, by_heading) = rayon::join(
        || begun(WayBy::Positions, &by_positions),
        || by_heading.as_ref().map(|way| begun(WayBy::Heading, way)),
    );
    let is_better = |by_heading: &Search<'_>| {
        let noise = &by_positions.noise;
        by_heading.misfit(noise) < by_positions.misfit(noise)
    };
    let by_heading = by_heading.filter(is_better);
    found(by_heading.unwrap_or(by_positions))
}

fn found(mut search: Search<'_>) -> Found {
    search.run();
    let left = search.left();
    let threshold = search.threshold_of_contacts();
    let is_contact = |pass: &Pass| pass.snr * pass.snr > threshold;
    let passes = (0..search.found.len()).into_par_iter().filter(|index| search.may_be_contact(*index));
    let passes = passes.filter_map(|index| pass(&search, &left, index));
    let mut passes: Vec<Pass> = passes.filter(is_contact).collect();
    passes.sort_by_key(|pass| pass.row);
    let candidates = search.found.iter().map(|located| located.fitted.dipole).collect();
    let (anomaly_nt, way_by) = (search.anomaly_nt(), search.options.way_by);
    Found { passes, candidates, anomaly_nt, noise: search.noise, threshold, way_by }
}
