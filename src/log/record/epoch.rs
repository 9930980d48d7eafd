//! One tick in the log: all that is needed to compute it again, and the answer to compare with.

use super::kind::EPOCH;
use crate::bytes::{Put, Take, put_some, take_some};
use crate::{Compensated, Epoch, Output, Status};

/// One tick: inputs and answer to the last bit, so that a replay can be compared with `==`.
///
/// Body, fields in brackets only when their flag is set:
/// `flags u8, status u8, tick u32, [0: scalar_pt i32], [1: flux_nt 3 x f32], [2: interference_nt f32,
/// compensated_pt i32, band_passed_nt f32, residual_nt f32, residual_after_update_nt f32], [3: battery_a f32],
/// [4: faults u32], [5: output tick u32, if it is another than the epoch's]`. Status: 0 used, 1 settling, 2 to 6
/// rejected, in the order of [`Rejection`](crate::Rejection). 48 bytes with its frame when both sensors and the battery are read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EpochRecord {
    /// What the core saw.
    pub epoch: Epoch,
    /// What it answered.
    pub output: Output,
    /// Battery current, ampere, positive when it discharges. It makes a field of its own.
    pub battery_a: Option<f32>,
    /// Fault flags as the firmware defines them; `None` when nothing has changed since the last.
    pub faults: Option<u32>,
}

const SCALAR: u8 = 1 << 0;
const FLUX: u8 = 1 << 1;
const COMPENSATED: u8 = 1 << 2;
const BATTERY: u8 = 1 << 3;
const FAULTS: u8 = 1 << 4;
const OUTPUT_TICK: u8 = 1 << 5;
const KNOWN_FLAGS: u8 = SCALAR | FLUX | COMPENSATED | BATTERY | FAULTS | OUTPUT_TICK;

impl EpochRecord {
    pub(super) fn put(&self, put: &mut Put<'_>) -> u8 {
        let Self { epoch, output, .. } = self;
        put.u8(self.flags());
        put.u8(output.status.code());
        put.u32(epoch.tick);
        put_some(epoch.scalar_pt, |scalar_pt| put.i32(scalar_pt));
        put_some(epoch.flux_nt, |flux_nt| flux_nt.iter().for_each(|&axis| put.f32(axis)));
        put_some(output.compensated, |compensated| put_compensated(&compensated, put));
        put_some(self.battery_a, |battery_a| put.f32(battery_a));
        put_some(self.faults, |faults| put.u32(faults));
        if output.tick != epoch.tick {
            put.u32(output.tick);
        }
        EPOCH
    }

    pub(super) fn take(take: &mut Take<'_>) -> Option<Self> {
        let flags = take.u8()?;
        if flags & !KNOWN_FLAGS != 0 {
            return None;
        }
        let has = |flag| flags & flag != 0;
        let status = Status::from_code(take.u8()?)?;
        let tick = take.u32()?;
        let scalar_pt = take_some(has(SCALAR), || take.i32())?;
        let flux_nt = take_some(has(FLUX), || Some([take.f32()?, take.f32()?, take.f32()?]))?;
        let compensated = take_some(has(COMPENSATED), || take_compensated(take))?;
        let battery_a = take_some(has(BATTERY), || take.f32())?;
        let faults = take_some(has(FAULTS), || take.u32())?;
        let output_tick = take_some(has(OUTPUT_TICK), || take.u32())?.unwrap_or(tick);
        Some(Self {
            epoch: Epoch { tick, scalar_pt, flux_nt },
            output: Output { tick: output_tick, status, compensated },
            battery_a,
            faults,
        })
    }

    fn flags(&self) -> u8 {
        let flag = |is_there: bool, flag| if is_there { flag } else { 0 };
        flag(self.epoch.scalar_pt.is_some(), SCALAR)
            | flag(self.epoch.flux_nt.is_some(), FLUX)
            | flag(self.output.compensated.is_some(), COMPENSATED)
            | flag(self.battery_a.is_some(), BATTERY)
            | flag(self.faults.is_some(), FAULTS)
            | flag(self.output.tick != self.epoch.tick, OUTPUT_TICK)
    }
}

fn put_compensated(compensated: &Compensated, put: &mut Put<'_>) {
    put.f32(compensated.interference_nt);
    put.i32(compensated.compensated_pt);
    put.f32(compensated.band_passed_nt);
    put.f32(compensated.residual_nt);
    put.f32(compensated.residual_after_update_nt);
}

fn take_compensated(take: &mut Take<'_>) -> Option<Compensated> {
    Some(Compensated {
        interference_nt: take.f32()?,
        compensated_pt: take.i32()?,
        band_passed_nt: take.f32()?,
        residual_nt: take.f32()?,
        residual_after_update_nt: take.f32()?,
    })
}
