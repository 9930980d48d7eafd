//! Settings and coefficients as bytes: the same in the log and in the flash.

use crate::bytes::{Put, Take};
use crate::estimate::{ElasticNet, Information, TRIANGLE};
use crate::filter::BandPassDesign;
use crate::model::Coefficients;
use crate::{Method, Settings};

/// `low_hz f64, high_hz f64, order u8, sample_rate_hz f64, method u8 (0 none, 1 fixed, 2 rls, 3 saddle-point, 4 adaptive),
/// lambda1 f64, lambda2 f64, forgetting f64, dual_step f64`.
pub(crate) fn put_settings(settings: &Settings, put: &mut Put<'_>) {
    let Settings { band_pass, method, penalty, forgetting, dual_step } = settings;
    put.f64(band_pass.low_hz);
    put.f64(band_pass.high_hz);
    match u8::try_from(band_pass.order) {
        Ok(order) => put.u8(order),
        Err(_) => put.refuse(),
    }
    put.f64(band_pass.sample_rate_hz);
    put.u8(match method {
        Method::None => 0,
        Method::Fixed => 1,
        Method::Rls => 2,
        Method::SaddlePoint => 3,
        Method::Adaptive => 4,
    });
    for value in [penalty.lambda1, penalty.lambda2, *forgetting, *dual_step] {
        put.f64(value);
    }
}

pub(crate) fn take_settings(take: &mut Take<'_>) -> Option<Settings> {
    Some(Settings {
        band_pass: BandPassDesign {
            low_hz: take.f64()?,
            high_hz: take.f64()?,
            order: usize::from(take.u8()?),
            sample_rate_hz: take.f64()?,
        },
        method: match take.u8()? {
            0 => Method::None,
            1 => Method::Fixed,
            2 => Method::Rls,
            3 => Method::SaddlePoint,
            4 => Method::Adaptive,
            _ => return None,
        },
        penalty: ElasticNet { lambda1: take.f64()?, lambda2: take.f64()? },
        forgetting: take.f64()?,
        dual_step: take.f64()?,
    })
}

/// `18 x f32`, in the core's basis.
pub(crate) fn put_coefficients(coefficients: &Coefficients, put: &mut Put<'_>) {
    coefficients.basis().iter().for_each(|&value| put.f32(value));
}

/// `None` also when one is not finite: [`Coefficients`] never are.
pub(crate) fn take_coefficients(take: &mut Take<'_>) -> Option<Coefficients> {
    let mut basis = *Coefficients::ZERO.basis();
    for value in &mut basis {
        *value = take.f32()?;
    }
    Coefficients::from_basis(basis)
}

/// `solution 18 x f32` in the core's basis, `triangle 171 x f32`, `noise_nt f32`.
pub(crate) fn put_information(information: &Information, put: &mut Put<'_>) {
    put_coefficients(information.centre(), put);
    information.triangle().iter().for_each(|&value| put.f32(value));
    put.f32(information.noise_nt());
}

/// `None` also when it is no [`Information`].
pub(crate) fn take_information(take: &mut Take<'_>) -> Option<Information> {
    let centre = take_coefficients(take)?;
    let mut triangle = [0.0; TRIANGLE];
    for value in &mut triangle {
        *value = take.f32()?;
    }
    Information::new(centre, triangle, take.f32()?)
}
