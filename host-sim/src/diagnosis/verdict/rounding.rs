//! The steps of the recorder, as they are told.

use crate::diagnosis::findings::{ChannelFindings, Findings};
use crate::diagnosis::result::RoundingFound;
use crate::diagnosis::rounding::coarsest_nt;

/// The steps of both sensors and their share of the noise.
pub(super) fn rounding_found(found: &Findings<'_>) -> RoundingFound {
    let rounding = &found.rounding;
    let scalar_noise_share = share(rounding.scalar_power_nt2(), &found.scalar);
    let flux_noise_share = share(rounding.fluxgate_power_nt2(found.table), &found.fluxgate);
    RoundingFound {
        scalar_nT: coarsest_nt(&rounding.scalar),
        flux_nT: coarsest_nt(rounding.fluxgate.iter().flatten()),
        noise_share: scalar_noise_share.max(flux_noise_share),
        scalar_noise_share,
        flux_noise_share,
    }
}

/// What rounding adds to the noise of a channel, over all of it. The noise of slow readings in coarse steps is not white:
/// the spectrum, which the background is taken from, may then have less of it than there is.
fn share(added_nt2: f64, channel: &ChannelFindings<'_>) -> f64 {
    let noise_nt = channel.selection.noise.std_nt().unwrap_or(0.0);
    added_nt2 / (noise_nt * noise_nt).max(added_nt2)
}
