//! Elementary functions with the same bits on every target.
//!
//! The functions of `f64` call the C library of the platform. Two libraries differ in the last bits, and a library may
//! select its code by the processor. The functions here are those of the crate `libm`, which are compiled from one
//! source for every target. `clippy.toml` of this crate bans the functions of `f64` that they replace.
//!
//! Square roots, remainders and roundings to whole numbers are exact by IEEE 754. They remain those of `f64`.
//!
//! ```
//! use vibrissa_runtime::math;
//! assert_eq!(math::sin(1.0).to_bits(), 0x3fea_ed54_8f09_0cee);
//! ```
//!
//! Why: docs/decisions/same-bits.md#commands-have-the-same-bits-on-every-target.

/// The sine of an angle (rad).
#[must_use]
pub fn sin(angle: f64) -> f64 {
    libm::sin(angle)
}

/// The cosine of an angle (rad).
#[must_use]
pub fn cos(angle: f64) -> f64 {
    libm::cos(angle)
}

/// The sine and the cosine of an angle (rad).
#[must_use]
pub fn sin_cos(angle: f64) -> (f64, f64) {
    libm::sincos(angle)
}

/// The tangent of an angle (rad).
#[must_use]
pub fn tan(angle: f64) -> f64 {
    libm::tan(angle)
}

/// The angle (rad, 0 to π) with this cosine. A NaN outside of −1 to 1.
#[must_use]
pub fn acos(cosine: f64) -> f64 {
    libm::acos(cosine)
}

/// The angle (rad, −π/2 to π/2) with this tangent.
#[must_use]
pub fn atan(tangent: f64) -> f64 {
    libm::atan(tangent)
}

/// The direction (rad, −π to π) of the vector (x, y). The signs of zeros count.
#[must_use]
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// The length of the vector (x, y), without overflow.
#[must_use]
pub fn hypot(x: f64, y: f64) -> f64 {
    libm::hypot(x, y)
}

/// e to the power of a number.
#[must_use]
pub fn exp(value: f64) -> f64 {
    libm::exp(value)
}

/// e to the power of a number, minus 1. It is accurate near 0.
#[must_use]
pub fn exp_m1(value: f64) -> f64 {
    libm::expm1(value)
}

/// The natural logarithm.
#[must_use]
pub fn ln(value: f64) -> f64 {
    libm::log(value)
}

/// The logarithm to the base 10.
#[must_use]
pub fn log10(value: f64) -> f64 {
    libm::log10(value)
}

/// A number to the power of another one.
#[must_use]
pub fn powf(value: f64, exponent: f64) -> f64 {
    libm::pow(value, exponent)
}

/// The cube root of a number.
#[must_use]
pub fn cbrt(value: f64) -> f64 {
    libm::cbrt(value)
}

/// The square of a number.
#[must_use]
pub fn square(value: f64) -> f64 {
    value * value
}

/// A number to a whole power, by repeated multiplication. A negative power is the reciprocal of the positive one.
#[must_use]
pub fn powi(value: f64, exponent: i32) -> f64 {
    let (mut power, mut factor, mut left) = (1.0, value, exponent.unsigned_abs());
    while left > 0 {
        if left % 2 == 1 {
            power *= factor;
        }
        factor *= factor;
        left /= 2;
    }
    if exponent < 0 { power.recip() } else { power }
}

/// The lesser of two numbers. A NaN counts as missing. Of two zeros it is the first, while `f64::min` leaves the sign
/// to the processor.
#[must_use]
pub fn min(a: f64, b: f64) -> f64 {
    if b < a || a.is_nan() { b } else { a }
}

/// The greater of two numbers. A NaN counts as missing. Of two zeros it is the first, while `f64::max` leaves the sign
/// to the processor.
#[must_use]
pub fn max(a: f64, b: f64) -> f64 {
    if b > a || a.is_nan() { b } else { a }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn of_two_zeros_the_first_remains() {
        for (a, b) in [(0.0, -0.0), (-0.0, 0.0)] {
            assert_eq!(min(a, b).to_bits(), f64::to_bits(a));
            assert_eq!(max(a, b).to_bits(), f64::to_bits(a));
        }
    }

    #[test]
    fn a_nan_counts_as_missing() {
        for of in [min, max] {
            assert_eq!((of(f64::NAN, 1.0), of(1.0, f64::NAN)), (1.0, 1.0));
            assert!(of(f64::NAN, f64::NAN).is_nan());
        }
    }

    proptest! {
        #[test]
        fn sine_and_cosine_together_have_the_bits_of_each(angle in prop_oneof![-10.0..10.0_f64, any::<f64>()]) {
            let (sine, cosine) = sin_cos(angle);
            prop_assert!(sine.to_bits() == sin(angle).to_bits() || sine.is_nan());
            prop_assert!(cosine.to_bits() == cos(angle).to_bits() || cosine.is_nan());
        }

        #[test]
        #[expect(clippy::disallowed_methods, reason = "the platform's functions are the independent ones")]
        fn the_functions_agree_with_those_of_the_platform(x in -20.0..20.0_f64, y in -20.0..20.0_f64) {
            let pairs = [
                (sin(x), x.sin()),
                (cos(x), x.cos()),
                (sin_cos(x).0, x.sin()),
                (sin_cos(x).1, x.cos()),
                (tan(x) / 1e3, x.tan() / 1e3),
                (acos(x / 20.0), (x / 20.0).acos()),
                (atan(x), x.atan()),
                (atan2(y, x), y.atan2(x)),
                (hypot(x, y), x.hypot(y)),
                (exp(x) / x.exp(), 1.0),
                (exp_m1(x) / x.exp_m1(), 1.0),
                (ln(x.abs()), x.abs().ln()),
                (log10(x.abs()), x.abs().log10()),
                (powf(x.abs(), 0.3), x.abs().powf(0.3)),
                (cbrt(x), x.cbrt()),
                (powi(x, 5) / x.powi(5), 1.0),
                (powi(x, -4) * x.powi(4), 1.0),
                (square(x), x * x),
                (min(x, y), x.min(y)),
                (max(x, y), x.max(y)),
            ];
            for (index, (found, expected)) in pairs.into_iter().enumerate() {
                prop_assert!((found - expected).abs() < 2e-14, "pair {index}: {found} {expected}");
            }
        }
    }
}
