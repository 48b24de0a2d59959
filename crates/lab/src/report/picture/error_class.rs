//! Classes of errors by fixed limits, the same in every picture.

/// The limits between the classes (mm), two in a decade. An error equal to a limit belongs to the class below.
pub(super) const LIMITS: [f64; 7] = [0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0];

/// One colour a class: blue up to 0.1 mm, yellow and orange up to 1 mm, dark red and darker beyond.
pub(super) const COLOURS: [&str; LIMITS.len() + 1] =
    ["#a5d8f7", "#3f9fdd", "#1a5fc0", "#ffd000", "#ea7a10", "#b80f1e", "#650a45", "#0d0d0d"];

/// The index of the class of an error (m). Errors that are not numbers belong to the last class.
pub(super) fn class(error: f64) -> usize {
    let millimetres = error * 1e3;
    LIMITS.iter().position(|limit| millimetres <= *limit).unwrap_or(LIMITS.len())
}

/// The colour of an error (m).
pub(in crate::report) fn colour_of(error: f64) -> &'static str {
    COLOURS[class(error)]
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use vibrissa_runtime::math;

    use super::*;

    /// Perceived linear RGB with full colour vision, and without the cones for long, medium and short waves. The
    /// matrices are those of Machado, Oliveira and Fernandes (2009) for severity 1.
    const VISIONS: [[[f64; 3]; 3]; 4] = [
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        [[0.152_286, 1.052_583, -0.204_868], [0.114_503, 0.786_281, 0.099_216], [-0.003_882, -0.048_116, 1.051_998]],
        [[0.367_322, 0.860_646, -0.227_968], [0.280_085, 0.672_501, 0.047_413], [-0.011_820, 0.042_940, 0.968_881]],
        [[1.255_528, -0.076_749, -0.178_779], [-0.078_411, 0.930_809, 0.147_602], [0.004_733, 0.691_367, 0.303_900]],
    ];

    /// From linear sRGB to CIE XYZ with the white point D65 (IEC 61966-2-1).
    const XYZ: [[f64; 3]; 3] = [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]];

    fn product(matrix: [[f64; 3]; 3], [a, b, c]: [f64; 3]) -> [f64; 3] {
        matrix.map(|[x, y, z]| x * a + y * b + z * c)
    }

    /// A colour in CIE L*a*b*, whose distances are approximately perceived differences.
    fn lab(colour: &str, vision: [[f64; 3]; 3]) -> [f64; 3] {
        let part = |k: usize| f64::from(u8::from_str_radix(&colour[k..k + 2], 16).unwrap()) / 255.0;
        let linear = |part: f64| if part <= 0.04045 { part / 12.92 } else { math::powf((part + 0.055) / 1.055, 2.4) };
        let seen = product(vision, [1, 3, 5].map(|k| linear(part(k)))).map(|part| part.clamp(0.0, 1.0));
        let [x, y, z] = product(XYZ, seen);
        let [x, y, z] =
            [x / 0.9505, y, z / 1.089].map(|t| if t > 0.008_856 { math::cbrt(t) } else { 7.787 * t + 16.0 / 116.0 });
        [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
    }

    fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
        a.iter().zip(b).map(|(a, b)| math::square(a - b)).sum::<f64>().sqrt()
    }

    #[test]
    fn every_class_is_distinguishable_from_the_others_and_the_ground_also_for_colour_blind_people() {
        for vision in VISIONS {
            for (index, one) in COLOURS.iter().enumerate() {
                for other in COLOURS[..index].iter().chain(["#ffffff"].iter()) {
                    // The least noticeable distance is 2.3.
                    let distance = distance(lab(one, vision), lab(other, vision));
                    assert!(distance > 20.0, "{one} and {other}: {distance}");
                }
            }
        }
    }

    #[test]
    fn a_class_reaches_to_its_limit_and_the_last_holds_the_rest() {
        for (index, limit) in LIMITS.into_iter().enumerate() {
            assert_eq!((class(limit * 0.999e-3), class(limit * 1.001e-3)), (index, index + 1));
        }
        assert_eq!((class(0.0), class(f64::INFINITY), class(f64::NAN)), (0, 7, 7));
    }
}
