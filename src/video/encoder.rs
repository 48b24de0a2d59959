//! Encoders of videos.

use super::error::VideoError;
use super::gif::GifEncoder;
use super::mp4::Mp4Encoder;
use super::settings::{Format, Settings};

/// Encodes pictures of one size: red, green and blue of every pixel, row by row from the top left.
pub(super) enum Encoder {
    Gif(Box<GifEncoder>),
    Mp4(Mp4Encoder),
}

impl Encoder {
    /// An encoder of no frames until now.
    ///
    /// # Errors
    /// [`VideoError::NoFfmpeg`] if MP4 is asked for and ffmpeg is missing.
    pub(super) fn new(format: Format, settings: &Settings) -> Result<Self, VideoError> {
        Ok(match format {
            Format::Gif => Self::Gif(Box::new(GifEncoder::new(settings))),
            Format::Mp4 => Self::Mp4(Mp4Encoder::start(settings)?),
        })
    }

    /// Shows a picture whose colours must be in the video. Call it before the first frame. MP4 needs none.
    pub(super) fn sample(&mut self, picture: &[u8]) {
        if let Self::Gif(gif) = self {
            gif.sample(picture);
        }
    }

    /// Adds a frame.
    ///
    /// # Errors
    /// [`VideoError`] if it cannot be encoded.
    pub(super) fn add(&mut self, picture: &[u8]) -> Result<(), VideoError> {
        match self {
            Self::Gif(gif) => gif.add(picture),
            Self::Mp4(mp4) => mp4.add(picture),
        }
    }

    /// The content of the file.
    ///
    /// # Errors
    /// [`VideoError`] if it cannot be encoded.
    pub(super) fn finish(self) -> Result<Vec<u8>, VideoError> {
        match self {
            Self::Gif(gif) => gif.finish(),
            Self::Mp4(mp4) => mp4.finish(),
        }
    }
}
