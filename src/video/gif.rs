//! Animated GIFs with one palette. A frame has only the pixels that change.

use std::collections::{HashMap, HashSet};

use gif::{Encoder, Frame, Repeat};

use super::error::VideoError;
use super::settings::Settings;

/// Number of colours of the palette. One more index means a pixel without a change.
const COLOURS: usize = 255;
const UNCHANGED: u8 = 255;

/// Encodes an animated GIF that repeats forever.
pub(super) struct GifEncoder {
    size: [u16; 2],
    rate: u32,
    samples: HashSet<[u8; 3]>,
    /// Made at the first frame.
    palette: Option<Palette>,
    encoder: Option<Encoder<Vec<u8>>>,
    /// Indices of the colours of the last frame.
    shown: Vec<u8>,
    frames: u32,
}

/// The colours of a GIF.
struct Palette {
    colours: Vec<[u8; 3]>,
    /// The indices of the colours that were asked for.
    known: HashMap<[u8; 3], u8>,
}

impl GifEncoder {
    pub(super) fn new(settings: &Settings) -> Self {
        Self {
            size: settings.size.map(|side| u16::try_from(side).unwrap_or(u16::MAX)),
            rate: settings.rate,
            samples: HashSet::new(),
            palette: None,
            encoder: None,
            shown: Vec::new(),
            frames: 0,
        }
    }

    /// Adds the colours of a picture to those from which the palette is made.
    pub(super) fn sample(&mut self, picture: &[u8]) {
        self.samples.extend(pixels_of(picture));
    }

    pub(super) fn add(&mut self, picture: &[u8]) -> Result<(), VideoError> {
        if self.frames == 0 {
            self.sample(picture);
        }
        let samples = &mut self.samples;
        let palette = self.palette.get_or_insert_with(|| Palette::of(std::mem::take(samples)));
        let indices: Vec<u8> = pixels_of(picture).map(|colour| palette.index(colour)).collect();
        let [width, height] = self.size;
        let encoder = match &mut self.encoder {
            Some(encoder) => encoder,
            none => {
                let mut encoder = Encoder::new(Vec::new(), width, height, palette.colours.as_flattened())?;
                encoder.set_repeat(Repeat::Infinite)?;
                none.insert(encoder)
            }
        };
        let mut frame = changes(&self.shown, &indices, width);
        frame.delay = delay(self.frames, self.rate);
        encoder.write_frame(&frame)?;
        self.shown = indices;
        self.frames += 1;
        Ok(())
    }

    pub(super) fn finish(self) -> Result<Vec<u8>, VideoError> {
        let encoder = self.encoder.ok_or(VideoError::Empty)?;
        Ok(encoder.into_inner()?)
    }
}

impl Palette {
    /// A palette for these colours. Until it is full, it receives the colour that is farthest from all colours in it. So thin lines keep
    /// their colours, and the largest error of a colour is at most twice the smallest possible one (Gonzalez 1985, doi
    /// 10.1016/0304-3975(85)90224-5).
    fn of(samples: HashSet<[u8; 3]>) -> Self {
        let mut samples: Vec<_> = samples.into_iter().map(|colour| (u32::MAX, colour)).collect();
        // The order decides among equal distances.
        samples.sort_unstable();
        let mut colours = Vec::new();
        while colours.len() < COLOURS
            && let Some((1.., farthest)) = samples.iter().copied().max()
        {
            colours.push(farthest);
            for (nearest, colour) in &mut samples {
                *nearest = distance(*colour, farthest).min(*nearest);
            }
        }
        Self { colours, known: HashMap::new() }
    }

    /// The index of the colour that is nearest to this one.
    fn index(&mut self, colour: [u8; 3]) -> u8 {
        let colours = &self.colours;
        *self.known.entry(colour).or_insert_with(|| {
            let nearest = colours.iter().enumerate().min_by_key(|(_, other)| distance(**other, colour));
            nearest.and_then(|(index, _)| u8::try_from(index).ok()).unwrap_or_default()
        })
    }
}

/// The squared distance of two colours.
fn distance(one: [u8; 3], other: [u8; 3]) -> u32 {
    one.iter().zip(other).map(|(one, other)| u32::from(one.abs_diff(other)).pow(2)).sum()
}

fn pixels_of(picture: &[u8]) -> impl Iterator<Item = [u8; 3]> {
    picture.as_chunks().0.iter().copied()
}

/// The frame with the pixels of `next` that differ from those of `shown`, which is empty before the first frame. `width`
/// is that of the picture.
fn changes(shown: &[u8], next: &[u8], width: u16) -> Frame<'static> {
    let columns = usize::from(width).max(1);
    let is_changed = |at: usize| shown.get(at) != next.get(at);
    let changed: Vec<usize> = (0..next.len()).filter(|at| is_changed(*at)).collect();
    // A frame has at least one pixel.
    let rows = changed.first().map_or(0, |at| at / columns)..=changed.last().map_or(0, |at| at / columns);
    let left = changed.iter().map(|at| at % columns).min().unwrap_or(0);
    let right = changed.iter().map(|at| at % columns).max().unwrap_or(0);
    let at = |row: usize, column: usize| row * columns + column;
    let places = rows.clone().flat_map(|row| (left..=right).map(move |column| at(row, column)));
    let pixel = |at: usize| if is_changed(at) { next.get(at).copied().unwrap_or(UNCHANGED) } else { UNCHANGED };
    let side = |length: usize| u16::try_from(length).unwrap_or(u16::MAX);
    Frame {
        left: side(left),
        top: side(*rows.start()),
        width: side(right - left + 1),
        height: side(rows.end() - rows.start() + 1),
        transparent: Some(UNCHANGED),
        buffer: places.map(pixel).collect(),
        ..Frame::default()
    }
}

/// The time (10 ms) that a frame is shown. Rounding errors do not add up.
fn delay(frame: u32, rate: u32) -> u16 {
    let time = |frame: u64| (frame * 100 + u64::from(rate) / 2) / u64::from(rate.max(1));
    let frame = u64::from(frame);
    u16::try_from(time(frame + 1) - time(frame)).unwrap_or(u16::MAX)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;
    use proptest::prelude::*;

    const SIZE: [u32; 2] = [16, 12];

    /// The pictures of a GIF as a viewer draws them, and their times (10 ms), by the decoder of the crate.
    fn decoded(bytes: &[u8]) -> (Vec<Vec<[u8; 3]>>, Vec<u16>) {
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::RGBA);
        let mut decoder = options.read_info(bytes).unwrap();
        let width = usize::from(decoder.width());
        let mut canvas = vec![[0; 3]; width * usize::from(decoder.height())];
        let (mut pictures, mut delays) = (Vec::new(), Vec::new());
        while let Some(frame) = decoder.read_next_frame().unwrap() {
            for (at, pixel) in frame.buffer.as_chunks::<4>().0.iter().enumerate() {
                let (row, column) = (at / usize::from(frame.width), at % usize::from(frame.width));
                if let [red, green, blue, u8::MAX] = *pixel {
                    canvas[(row + usize::from(frame.top)) * width + column + usize::from(frame.left)] =
                        [red, green, blue];
                }
            }
            pictures.push(canvas.clone());
            delays.push(frame.delay);
        }
        (pictures, delays)
    }

    proptest! {
        #[test]
        fn a_decoded_gif_shows_every_picture(
            // Colours that are far apart, so that a palette has all of them.
            pictures in prop::collection::vec(prop::collection::vec(0..4_usize, (SIZE[0] * SIZE[1]) as usize), 1..6),
            still in 0..3_usize,
        ) {
            const PALETTE: [[u8; 3]; 4] = [[250, 250, 250], [10, 10, 10], [200, 30, 30], [30, 60, 200]];
            let mut pictures: Vec<Vec<[u8; 3]>> =
                pictures.iter().map(|picture| picture.iter().map(|colour| PALETTE[*colour]).collect()).collect();
            let last = pictures[pictures.len() - 1].clone();
            pictures.extend(std::iter::repeat_n(last, still));
            let mut encoder = GifEncoder::new(&Settings { size: SIZE, ..Settings::default() });
            let bytes = |picture: &Vec<[u8; 3]>| picture.concat();
            for picture in &pictures {
                encoder.sample(&bytes(picture));
            }
            for picture in &pictures {
                encoder.add(&bytes(picture)).unwrap();
            }
            let (shown, _) = decoded(&encoder.finish().unwrap());
            prop_assert_eq!(shown.len(), pictures.len());
            for (shown, picture) in shown.iter().flatten().zip(pictures.iter().flatten()) {
                let differs = shown.iter().zip(picture).any(|(a, b)| a.abs_diff(*b) > 8);
                prop_assert!(!differs, "{:?} instead of {:?}", shown, picture);
            }
        }

        #[test]
        fn frames_are_never_later_than_half_a_hundredth_of_a_second(rate in 1_u32..=50, frames in 1_u32..2000) {
            let shown: u64 = (0..frames).map(|frame| u64::from(delay(frame, rate))).sum();
            let exact = 100.0 * f64::from(frames) / f64::from(rate);
            prop_assert!((shown as f64 - exact).abs() <= 0.5 + 1e-9, "{shown} instead of {exact}");
            // Browsers slow a shorter one down.
            prop_assert!((0..frames).all(|frame| delay(frame, rate) >= 2));
        }
    }

    #[test]
    fn a_gif_without_frames_is_refused() {
        let encoder = GifEncoder::new(&Settings::default());
        assert!(matches!(encoder.finish(), Err(VideoError::Empty)));
    }
}
