//! Contacts where positions are a receiver's: the tows of the [contacts](super::contacts), all with positions of the body, which the
//! simulator knows to a millimetre, with the error of one of three receivers in turn.
//!
//! Errors of a receiver without corrections keep for a minute and more (El-Rabbany and Kleusberg 2003); one at 1 Hz stands still in between.

use std::f64::consts::TAU;
use std::time::Instant;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use super::contacts::{Outcome, all, along, by_motion, failures, false_ones, found, found_and_false, list, of_snr};
use super::draw::{Drawn, Knows, tow};
use super::program;
use super::score::FOUND_FROM;
use super::table::{FREE, finish};
use super::zero_phase::RATE_HZ;

/// Metres a degree of latitude.
const M_PER_DEG: f64 = 40_008_000.0 / 360.0;

/// What a receiver adds to the places of a body, either axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Receiver {
    pub(crate) name: &'static str,
    /// Rows in which it gives the same position.
    pub(crate) held_rows: usize,
    /// Error from one position to the next, m rms.
    pub(crate) noise_m: f64,
    /// Error that keeps for a while, m rms: of first order, of this time constant.
    pub(crate) wander_m: f64,
    pub(crate) wander_s: f64,
}

const RECEIVERS: [Receiver; 3] = [
    Receiver { name: "1 Hz, 0.3 m", held_rows: 10, noise_m: 0.3, wander_m: 0.0, wander_s: 60.0 },
    Receiver { name: "10 Hz, 1 m over a minute", held_rows: 1, noise_m: 0.02, wander_m: 1.0, wander_s: 60.0 },
    Receiver { name: "10 Hz, 1 m", held_rows: 1, noise_m: 1.0, wander_m: 0.0, wander_s: 60.0 },
];

impl Receiver {
    /// That of a seed: motions take turns with seeds, receivers with threes of them.
    fn of(seed: u64) -> Self {
        RECEIVERS[(seed / 3 % 3) as usize]
    }

    /// The recording as this receiver gives its positions.
    pub(crate) fn seen(&self, recording: &[u8], seed: u64) -> Result<Vec<u8>, csv::Error> {
        let mut reader = csv::Reader::from_reader(recording);
        let header = reader.headers()?.clone();
        let column = |name: &str| header.iter().position(|own| own == name).expect("a tow with positions");
        let columns = [column("latitude_deg"), column("longitude_deg")];
        let rows: Vec<csv::StringRecord> = reader.records().collect::<Result<_, _>>()?;
        let errors_m = self.errors_m(rows.len(), seed);
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(&header)?;
        for (row, own) in rows.iter().enumerate() {
            // What is held is where the body was.
            let given = row / self.held_rows * self.held_rows;
            let degrees = columns.map(|column| rows[given][column].parse::<f64>().expect("degrees"));
            let per_deg_m = [M_PER_DEG, M_PER_DEG * (degrees[0] * TAU / 360.0).cos()];
            let text = |axis: usize| format!("{:.8}", degrees[axis] + errors_m[given][axis] / per_deg_m[axis]);
            let field = |(column, field): (usize, &str)| {
                columns.iter().position(|own| *own == column).map_or_else(|| field.to_string(), text)
            };
            writer.write_record(own.iter().enumerate().map(field))?;
        }
        Ok(writer.into_inner().expect("memory takes all"))
    }

    fn errors_m(&self, rows: usize, seed: u64) -> Vec<[f64; 2]> {
        // Apart from the streams of the simulator and of the draw.
        let mut random = ChaCha8Rng::seed_from_u64(seed ^ 0x7265_6365_6976_6572);
        let mut normal = || -> [f64; 2] { std::array::from_fn(|_| StandardNormal.sample(&mut random)) };
        let keeps = (-1.0 / (self.wander_s * RATE_HZ)).exp();
        let mut wander_m = normal().map(|x| self.wander_m * x);
        let mut error_m = || {
            let [step, noise] = [normal(), normal()];
            let grows_m = self.wander_m * (1.0 - keeps * keeps).sqrt();
            wander_m = std::array::from_fn(|axis| keeps * wander_m[axis] + grows_m * step[axis]);
            std::array::from_fn(|axis| wander_m[axis] + self.noise_m * noise[axis])
        };
        (0..rows).map(|_| error_m()).collect()
    }
}

fn tow_with_receiver(seed: u64) -> Drawn {
    let mut drawn = tow(seed);
    let scenario = &mut drawn.scenario;
    (scenario.columns.position, scenario.columns.speed, scenario.ship) = (true, false, None);
    Drawn { knows: Knows::Position, receiver: Some(Receiver::of(seed)), ..drawn }
}

#[test]
fn a_receiver_errs_as_it_says_and_stands_still_in_between() {
    let recording: String = (0..4_000).fold("time_s,latitude_deg,longitude_deg\n".into(), |text, row| {
        text + &format!("{},60.00000000,{:.8}\n", row as f64 / RATE_HZ, 20.0 + 1e-6 * f64::from(row))
    });
    for receiver in RECEIVERS {
        let seen = receiver.seen(recording.as_bytes(), 5).unwrap();
        let rows: Vec<[f64; 3]> = csv::Reader::from_reader(&seen[..]).deserialize().map(Result::unwrap).collect();
        let north_m: Vec<f64> = rows.iter().map(|row| (row[1] - 60.0) * M_PER_DEG).collect();
        let rms_m = (north_m.iter().map(|m| m * m).sum::<f64>() / north_m.len() as f64).sqrt();
        let whole_m = receiver.noise_m.hypot(receiver.wander_m);
        assert!((0.5..1.6).contains(&(rms_m / whole_m)), "{}: {rms_m} m", receiver.name);
        let changes = rows.windows(2).filter(|pair| pair[0][1..] != pair[1][1..]).count();
        assert_eq!(changes, rows.len().div_ceil(receiver.held_rows) - 1, "{}", receiver.name);
        assert!(rows.iter().enumerate().all(|(row, own)| own[0] == row as f64 / RATE_HZ), "{}", receiver.name);
    }
}

#[test]
#[ignore = "minutes, and the survey; see the top of survey_trial.rs"]
fn receivers() {
    let begin = Instant::now();
    let (outcomes, failed) = all("receivers", program::seeds(701..1101), tow_with_receiver);
    list(&outcomes);
    let every: Vec<&Outcome> = outcomes.iter().collect();
    let mut figures = vec![
        failures(&outcomes, failed),
        found("Found at SNR 8 and more", &every, [0.95, FREE[1]], of_snr(FOUND_FROM..f64::INFINITY)),
        false_ones("False in an hour", &every, 1.0),
    ];
    for receiver in RECEIVERS {
        let of: Vec<&Outcome> =
            every.iter().copied().filter(|outcome| Receiver::of(outcome.seed) == receiver).collect();
        figures.extend(found_and_false(receiver.name, &of));
    }
    figures.extend(by_motion(&outcomes));
    figures.push(along("Position along the track, 68 % below, m", &outcomes, Knows::Position, FREE[1]));
    println!("{} tows, {:.0} s", outcomes.len(), begin.elapsed().as_secs_f64());
    finish("Contacts with a receiver's positions", &figures);
}
