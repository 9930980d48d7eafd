//! From the rows of a recording to what the sensors send at each conversion.

use std::collections::VecDeque;

use super::faults::{Fault, FaultKind};
use crate::recording::{Column, RecordingError, RecordingReader, RecordingRow};
use towmag::housekeeping::HousekeepingSample;
use towmag::sensors::nmea::M_PER_DBAR;
use towmag::sensors::scalar::Sensor;

/// Scale that the emulated fluxgate has, nT per count: the resolution of recordings, and room for 83,000 nT.
pub(crate) const NT_PER_COUNT: f64 = 0.01;

/// Scale of the emulated divider, V per count: that of the chip's converter reaches to 40.95 V.
pub(crate) const V_PER_COUNT: f64 = 0.01;

/// What the chip's converter gives at most.
const MOST_BATTERY_COUNTS: f64 = 4_095.0;

/// What the converter gives where the recording has no vector: the firmware takes it for clipped.
const CLIPPED: [i32; 4] = [8_388_607, 8_388_607, 8_388_607, 0];

/// Epochs of a gap that are fed, so that the body sees one without living through all of it.
const LONGEST_GAP: u32 = 20;

/// Epochs before the first row, in which the body sets up its converter.
const LEAD_IN: u64 = 3;

/// Epochs after the last row, until even the grid has given out all that it holds.
const LEAD_OUT: u64 = 8;

/// What happens at one conversion.
#[derive(Clone, Debug, Default)]
pub(crate) struct Step {
    /// Counts of the four channels.
    pub(crate) counts: [i32; 4],
    /// What the scalar sensor sends.
    pub(crate) sentence: Vec<u8>,
    /// What the depth sensor sends.
    pub(crate) nmea: Vec<u8>,
    /// Leak contact and battery.
    pub(crate) housekeeping: HousekeepingSample,
    /// The row that this conversion is the middle of.
    pub(crate) row: Option<u64>,
    /// Whether the frame is damaged on its way.
    pub(crate) damaged_frame: bool,
    /// Whether the converter is there.
    pub(crate) unplugged: bool,
    /// What befalls the body.
    pub(crate) blow: Option<FaultKind>,
}

/// Reads a recording and makes it into steps.
pub(crate) struct Feed<'a> {
    recording: Box<dyn RecordingReader + 'a>,
    row: RecordingRow,
    rows: u64,
    last_tick: Option<u32>,
    sensor: Sensor,
    per_epoch: usize,
    faults: Vec<Fault>,
    ready: VecDeque<Step>,
    counts: [i32; 4],
    housekeeping: HousekeepingSample,
    late: Vec<u8>,
    last_sentence: Vec<u8>,
    lead_out: Option<u64>,
}

impl<'a> Feed<'a> {
    pub(crate) fn new(
        recording: Box<dyn RecordingReader + 'a>,
        sensor: Sensor,
        per_epoch: usize,
        faults: Vec<Fault>,
    ) -> Self {
        let mut feed = Self {
            recording,
            row: RecordingRow::default(),
            rows: 0,
            last_tick: None,
            sensor,
            per_epoch,
            faults,
            ready: VecDeque::new(),
            counts: CLIPPED,
            housekeeping: HousekeepingSample::default(),
            late: Vec::new(),
            last_sentence: Vec::new(),
            lead_out: None,
        };
        for _ in 0..LEAD_IN {
            feed.empty_epoch();
        }
        feed
    }

    /// What happens at the next conversion; `None` when the recording is over.
    pub(crate) fn next(&mut self) -> Result<Option<Step>, RecordingError> {
        if !self.fill()? {
            let left = self.lead_out.get_or_insert(LEAD_OUT);
            if *left == 0 {
                return Ok(None);
            }
            *left -= 1;
            self.empty_epoch();
        }
        Ok(self.ready.pop_front())
    }

    /// Rows read so far.
    pub(crate) fn rows(&self) -> u64 {
        self.rows
    }

    /// Have a conversion ready, if rows are left: a row without a place on the grid has none.
    fn fill(&mut self) -> Result<bool, RecordingError> {
        while self.ready.is_empty() {
            if !self.read()? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    fn read(&mut self) -> Result<bool, RecordingError> {
        let mut row = std::mem::take(&mut self.row);
        let read = self.recording.read_row(&mut row)?;
        if read {
            if row.is_on_grid {
                self.gap_before(row.epoch.tick);
                self.epoch(&row);
            }
            self.rows += 1;
        }
        self.row = row;
        Ok(read)
    }

    fn gap_before(&mut self, tick: u32) {
        let missing = self.last_tick.map_or(0, |last| tick.wrapping_sub(last).saturating_sub(1));
        for _ in 0..missing.min(LONGEST_GAP) {
            self.empty_epoch();
        }
        self.last_tick = Some(tick);
    }

    fn empty_epoch(&mut self) {
        self.counts = CLIPPED;
        for _ in 0..self.per_epoch {
            self.push(Step::default());
        }
    }

    /// The conversions of a row, the sentence with the middle one.
    fn epoch(&mut self, row: &RecordingRow) {
        let index = self.rows;
        let mut sentence = self.sentence_of(row);
        let befalls = |kind| Fault::any(&self.faults, kind, index);
        let late = befalls(FaultKind::Late);
        let damaged_frame = befalls(FaultKind::Crc);
        let blow = [FaultKind::Reset, FaultKind::Power, FaultKind::Panic].into_iter().find(|&kind| befalls(kind));
        let unplugged = befalls(FaultKind::Unplug);
        self.counts = counts(row);
        self.housekeeping = housekeeping(row);
        for conversion in 0..self.per_epoch {
            let mut step = Step { unplugged, ..Step::default() };
            if conversion == self.per_epoch / 2 {
                step = Step { row: Some(index), nmea: nmea_of(row), damaged_frame, blow, ..step };
                if !late {
                    step.sentence = std::mem::take(&mut sentence);
                }
            }
            self.push(step);
        }
        self.late = sentence;
    }

    /// What the scalar sensor's line brings of a row.
    fn sentence_of(&mut self, row: &RecordingRow) -> Vec<u8> {
        let index = self.rows;
        let befalls = |kind| Fault::any(&self.faults, kind, index);
        let sent = row.epoch.scalar_pt.and_then(|scalar_pt| self.sensor.encode(scalar_pt));
        let mut sentence = sent.map(|sentence| sentence.as_bytes().to_vec()).unwrap_or_default();
        if befalls(FaultKind::Stuck) && !self.last_sentence.is_empty() {
            sentence.clone_from(&self.last_sentence);
        }
        self.last_sentence.clone_from(&sentence);
        if befalls(FaultKind::Drop) {
            sentence.clear();
        }
        if befalls(FaultKind::Damage) {
            let middle = sentence.len() / 2;
            sentence.iter_mut().skip(middle).take(1).for_each(|byte| *byte ^= 0x55);
        }
        if befalls(FaultKind::Noise) {
            // A different mixture of digits, line ends, dollar signs and bytes above 127 in every row.
            sentence = (0..17).map(|i| (index.wrapping_mul(31) + i * i * 7) as u8).collect();
        }
        sentence
    }

    fn push(&mut self, step: Step) {
        let mut sentence = std::mem::take(&mut self.late);
        sentence.extend_from_slice(&step.sentence);
        self.ready.push_back(Step { counts: self.counts, housekeeping: self.housekeeping, sentence, ..step });
    }
}

/// The sentence of a sensor that tells depth and altitude; one that knows neither is silent.
fn nmea_of(row: &RecordingRow) -> Vec<u8> {
    let sentence = match [Column::Depth, Column::Altitude].map(|column| row.number(column)) {
        [None, None] => return Vec::new(),
        [Some(depth_m), None] => format!("PIPS,{depth_m:.3},M"),
        [depth_m, Some(altitude_m)] => {
            let dbar = depth_m.map(|depth_m| format!("{:.4}", depth_m / M_PER_DBAR)).unwrap_or_default();
            format!("PRVAT,{altitude_m:.3},M,{dbar},dBar")
        }
    };
    let sum = sentence.bytes().fold(0, |sum, byte| sum ^ byte);
    format!("${sentence}*{sum:02X}\r\n").into_bytes()
}

/// Leak contact and battery; a contact that the row does not tell of is dry.
fn housekeeping(row: &RecordingRow) -> HousekeepingSample {
    let counts = |volts: f64| (volts / V_PER_COUNT).round().clamp(0.0, MOST_BATTERY_COUNTS) as u16;
    let battery_counts = row.number(Column::BatteryVoltage).map(counts);
    HousekeepingSample { is_wet: row.flag(Column::Leak).unwrap_or(false), battery_counts }
}

fn counts(row: &RecordingRow) -> [i32; 4] {
    let Some(flux_nt) = row.flux_nt() else { return CLIPPED };
    let [x, y, z] = flux_nt.map(|component_nt| (component_nt / NT_PER_COUNT).round() as i32);
    [x, y, z, 0]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::CsvReader;
    use towmag::sensors::scalar::{Format, ScalarSettings};

    const TEXT: &str = "time_s,scalar_nT,flux_x_nT,flux_y_nT,flux_z_nT\n\
                        0.0,50000,20000,0,45000\n0.1,50001,20001,0,45000\n0.1,50001,20001,0,45000\n";

    /// The rows of the recording that the steps belong to.
    fn rows(text: &str) -> Vec<u64> {
        let mut recording = CsvReader::from_reader("rec.csv", text.as_bytes()).unwrap();
        recording.tolerate();
        let sensor = ScalarSettings::of(Format::named("g882").unwrap()).format.build().unwrap();
        let mut feed = Feed::new(Box::new(recording), sensor, 1, Vec::new());
        let mut rows = Vec::new();
        while let Some(step) = feed.next().unwrap() {
            rows.push(step.row);
        }
        rows.into_iter().flatten().collect()
    }

    #[test]
    fn a_row_without_a_place_on_the_grid_is_never_sent() {
        let more: String = (2..30).map(|k| format!("{:.1},50000,20000,0,45000\n", f64::from(k) / 10.0)).collect();
        let expected: Vec<u64> = (0..31).filter(|&row| row != 2).collect();
        assert_eq!(rows(&format!("{TEXT}{more}")), expected);
    }
}
