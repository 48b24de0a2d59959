//! A rough outline has the height of its texture, and otherwise the form of the smooth one.

use std::f64::consts::{PI, TAU};

use proptest::prelude::*;
use vibrissa::geometry::{Contour, Piece, Point2, Texture, TextureError, TextureKind, circle, polygon};

fn kind() -> impl Strategy<Value = TextureKind> {
    prop_oneof![Just(TextureKind::Ridges), Just(TextureKind::Random)]
}

/// Textures that are not too steep.
fn texture() -> impl Strategy<Value = Texture> {
    (kind(), 2e-3..1e-2_f64, 0.001..0.03_f64, any::<u64>()).prop_map(|(kind, wavelength, ratio, seed)| Texture {
        kind,
        amplitude: ratio * wavelength,
        wavelength,
        seed,
    })
}

/// The heights (m) of a rough circle about the origin, at equal angles.
fn heights(radius: f64, texture: &Texture) -> Vec<f64> {
    let rough = circle(Point2::origin(), radius).unwrap().textured(texture).unwrap();
    assert!(rough.corners().is_empty());
    let count = 4000;
    let height = |index: i32| {
        let (sin, cos) = (TAU * f64::from(index) / f64::from(count)).sin_cos();
        // The surface is crossed once along each radius.
        let (mut inner, mut outer) = (0.5 * radius, 1.5 * radius);
        for _ in 0..40 {
            let middle = 0.5 * (inner + outer);
            let is_inside = rough.contains(Point2::new(middle * cos, middle * sin));
            *(if is_inside { &mut inner } else { &mut outer }) = middle;
        }
        inner - radius
    };
    (0..count).map(height).collect()
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    values.sum::<f64>() / count
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn the_height_has_the_mean_zero_and_the_given_standard_deviation(texture in texture(), radius in 0.05..0.2_f64) {
        let heights = heights(radius, &texture);
        let mean_height = mean(heights.iter().copied());
        let deviation = mean(heights.iter().map(|height| height * height)).sqrt();
        prop_assert!(mean_height.abs() < 0.01 * texture.amplitude, "{mean_height}");
        prop_assert!((deviation / texture.amplitude - 1.0).abs() < 0.02, "{deviation}");
    }

    #[test]
    fn no_wave_is_shorter_than_the_wavelength(texture in texture(), radius in 0.05..0.2_f64) {
        let heights = heights(radius, &texture);
        let crossings = (0..heights.len()).filter(|&k| heights[k] * heights[(k + 1) % heights.len()] < 0.0).count();
        prop_assert!(crossings as f64 <= 2.0 * TAU * radius / texture.wavelength, "{crossings}");
    }

    #[test]
    fn corners_keep_their_positions_and_angles(texture in texture()) {
        let smooth = polygon(&[(0.0, 0.0), (0.3, 0.0), (0.1, 0.1), (0.0, 0.3)].map(|(x, y)| Point2::new(x, y))).unwrap();
        let rough = smooth.textured(&texture).unwrap();
        let (smooth, rough) = (smooth.corners(), rough.corners());
        prop_assert_eq!(smooth.len(), rough.len());
        for (one, other) in smooth.iter().zip(&rough) {
            prop_assert!((one.point - other.point).norm() < 1e-9 && (one.turn - other.turn).abs() < 1e-6);
        }
    }
}

#[test]
fn the_seed_determines_the_texture() {
    let texture = |seed| Texture { kind: TextureKind::Random, amplitude: 5e-5, wavelength: 5e-3, seed };
    let [one, same, other] = [1, 1, 2].map(|seed| heights(0.1, &texture(seed)));
    assert_eq!(one, same);
    let product = mean(one.iter().zip(&other).map(|(one, other)| one * other));
    assert!(product.abs() < 0.5 * 5e-5 * 5e-5, "heights of different seeds are correlated: {product}");
}

#[test]
fn an_outline_without_room_for_a_texture_is_refused() {
    let texture = Texture { kind: TextureKind::Ridges, amplitude: 1e-4, wavelength: 5e-3, seed: 0 };
    let bend = circle(Point2::origin(), 3e-4).unwrap().textured(&texture);
    assert!(matches!(bend, Err(TextureError::Bend { .. })), "{bend:?}");
    let open = Contour::open(vec![Piece::arc(Point2::origin(), 0.1, 0.0, PI)]).unwrap().textured(&texture);
    assert_eq!(open.err(), Some(TextureError::Open));
    let blade = [(0.0, 0.0), (0.1, 0.0), (0.1, 1e-4), (0.0, 1e-4)].map(|(x, y)| Point2::new(x, y));
    let blade = polygon(&blade).unwrap().textured(&Texture { kind: TextureKind::Random, ..texture });
    assert!(matches!(blade, Err(TextureError::Contour(_))), "{blade:?}");
}
