//! What the contacts of a survey are worth against the truth.
//!
//! Passes count whose own signal to noise is 3 or more: a line far away tells nothing. A contact meets a pass if it lies within 1 s of it, or within half the distance over the speed where that is more. It
//! belongs to the nearest in time of those that it meets. A dipole is found if a contact belongs to any of its passes. False is a contact
//! that meets no pass, and every further one that belongs to the same pass.

use super::csv_file::CsvFile;
use super::truth::{Iron, Pass};

/// Signal to noise from which a dipole has to be found, and from which its figures have to be right.
pub(crate) const FOUND_FROM: f64 = 8.0;
pub(crate) const MEASURED_FROM: f64 = 15.0;

/// Signal to noise from which a contact may be due to a pass.
pub(crate) const SEEN_FROM: f64 = 3.0;

/// A row of `contacts.csv`; not a number where a field is empty.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Contact {
    pub(crate) time_s: f64,
    pub(crate) snr: f64,
    /// How often the object was passed.
    pub(crate) passes: f64,
    pub(crate) place_deg: [f64; 2],
    /// Best, low, high.
    pub(crate) distance_m: [f64; 3],
    pub(crate) moment_am2: [f64; 3],
}

impl Contact {
    pub(crate) fn all(table: &CsvFile) -> Vec<Self> {
        let of = |names: [&str; 3]| names.map(|name| table.numbers(name));
        let [time_s, snr, passes] = of(["time_s", "snr", "passes"]);
        let place_deg = ["latitude_deg", "longitude_deg"].map(|name| table.numbers(name));
        let distance_m = of(["distance_m", "distance_low_m", "distance_high_m"]);
        let moment_am2 = of(["moment_Am2", "moment_low_Am2", "moment_high_Am2"]);
        let row = |k: usize| Self {
            time_s: time_s[k],
            snr: snr[k],
            passes: passes[k],
            place_deg: [place_deg[0][k], place_deg[1][k]],
            distance_m: [0, 1, 2].map(|i: usize| distance_m[i][k]),
            moment_am2: [0, 1, 2].map(|i: usize| moment_am2[i][k]),
        };
        (0..table.len()).map(row).collect()
    }
}

/// Which contact belongs to which pass of which dipole.
#[derive(Debug, Default)]
pub(crate) struct Matched {
    /// For each dipole its contacts, each with the pass that it belongs to.
    pub(crate) of: Vec<Vec<(Pass, Contact)>>,
    pub(crate) false_ones: Vec<Contact>,
}

pub(crate) fn matched(iron: &[Iron], contacts: &[Contact], speed_m_per_s: f64) -> Matched {
    let mut matched = Matched { of: vec![Vec::new(); iron.len()], false_ones: Vec::new() };
    for contact in contacts {
        let off_s = |pass: &Pass| (contact.time_s - pass.time_s).abs();
        let meets = |pass: &Pass| off_s(pass) <= (0.5 * pass.distance_m / speed_m_per_s).max(1.0);
        let best = iron
            .iter()
            .enumerate()
            .flat_map(|(k, iron)| iron.passes.iter().map(move |(pass, snr)| (k, *pass, *snr)))
            .filter(|(_, pass, snr)| *snr >= SEEN_FROM && meets(pass))
            .map(|(k, pass, _)| (k, pass))
            .min_by(|(_, a), (_, b)| off_s(a).total_cmp(&off_s(b)));
        match best {
            Some((k, pass)) if matched.of[k].iter().all(|(other, _)| other.row != pass.row) => {
                matched.of[k].push((pass, *contact));
            }
            _ => matched.false_ones.push(*contact),
        }
    }
    matched
}

/// Whether an interval holds the truth; an empty one does not.
pub(crate) fn holds([_, low, high]: [f64; 3], truth: f64) -> bool {
    (low..=high).contains(&truth)
}

#[cfg(test)]
mod tests {
    use super::super::draw::tow;
    use super::super::truth::iron;
    use super::*;
    use host_sim::simulator::scenario::Simulation;

    fn at(time_s: f64) -> Contact {
        Contact {
            time_s,
            snr: 20.0,
            passes: 1.0,
            place_deg: [f64::NAN; 2],
            distance_m: [4.0, 3.0, 5.0],
            moment_am2: [f64::NAN; 3],
        }
    }

    #[test]
    fn the_right_answer_is_right_and_each_wrong_one_is_counted() {
        let drawn = (1..).map(tow).find(|drawn| drawn.scenario.dipoles.len() >= 4).unwrap();
        let simulation = Simulation::new(&drawn.scenario, 1).unwrap();
        let speed_m_per_s = drawn.scenario.motion.speed_m_per_s().unwrap();
        let mut iron = iron(&simulation);
        iron.retain(|iron| iron.snr() >= SEEN_FROM);
        assert!(iron.len() >= 2);
        let best = |iron: &Iron| iron.passes.iter().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap().0;
        let mut contacts: Vec<Contact> = iron.iter().map(|iron| at(best(iron).time_s)).collect();
        let right = matched(&iron, &contacts, speed_m_per_s);
        assert!(right.of.iter().all(|of| of.len() == 1) && right.false_ones.is_empty());
        // One twice, one beside, one nowhere near.
        contacts.push(at(best(&iron[0]).time_s + 0.2));
        contacts[1].time_s += 1.1 * (0.5 * best(&iron[1]).distance_m / speed_m_per_s).max(1.0);
        contacts.push(at(-100.0));
        let wrong = matched(&iron, &contacts, speed_m_per_s);
        assert_eq!((wrong.of[0].len(), wrong.of[1].len(), wrong.false_ones.len()), (1, 0, 3));
    }

    #[test]
    fn an_empty_interval_holds_nothing() {
        assert!(holds(at(0.0).distance_m, 3.5) && !holds(at(0.0).distance_m, 5.5) && !holds(at(0.0).moment_am2, 1.0));
    }
}
