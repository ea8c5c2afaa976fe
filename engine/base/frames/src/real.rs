//! Elementary functions with the same result on every machine (from the `libm` crate, not from the platform).

pub use core::f64::consts::{FRAC_PI_2, PI, TAU};

macro_rules! one_argument {
    ($($(#[$doc:meta])* $name:ident),* $(,)?) => {$(
        $(#[$doc])*
        #[inline]
        pub fn $name(x: f64) -> f64 {
            libm::$name(x)
        }
    )*};
}

one_argument! {
    /// Sine of an angle in radians.
    sin,
    /// Cosine of an angle in radians.
    cos,
    /// Tangent of an angle in radians.
    tan,
    /// Arc sine, radians.
    asin,
    /// Arc cosine, radians.
    acos,
    /// Arc tangent, radians.
    atan,
    /// Exponential function.
    exp,
}

/// Natural logarithm.
#[inline]
pub fn ln(x: f64) -> f64 {
    libm::log(x)
}

/// Angle of the vector (`x`, `y`), radians in (-pi, pi].
#[inline]
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// `base` raised to `exponent`.
#[inline]
pub fn powf(base: f64, exponent: f64) -> f64 {
    libm::pow(base, exponent)
}

/// Length of the vector (`x`, `y`).
#[inline]
pub fn hypot(x: f64, y: f64) -> f64 {
    (x * x + y * y).sqrt()
}

/// Sine and cosine of an angle in radians.
#[inline]
pub fn sin_cos(x: f64) -> (f64, f64) {
    libm::sincos(x)
}

/// Equivalent angle in (-pi, pi], radians.
pub fn wrap_angle_rad(angle_rad: f64) -> f64 {
    let turned = angle_rad - TAU * ((angle_rad + PI) / TAU).floor();
    if turned <= -PI { turned + TAU } else { turned }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrapped_angles_stay_in_one_turn() {
        for (given, expected) in [(3.0 * PI, PI), (-PI, PI), (0.5, 0.5), (-7.0, TAU - 7.0)] {
            assert!((wrap_angle_rad(given) - expected).abs() < 1e-12, "{given}");
        }
    }
}
