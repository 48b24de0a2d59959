//! Settings of a video.

use std::path::Path;

use super::error::VideoError;

/// The format of a video.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// An animated GIF.
    Gif,
    /// H.264 in MP4, encoded by ffmpeg.
    Mp4,
}

impl Format {
    /// The format with this name, in capital or small letters.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        [Self::Gif, Self::Mp4].into_iter().find(|format| name.eq_ignore_ascii_case(format.name()))
    }

    /// Its name, which is also the extension of its files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Gif => "gif",
            Self::Mp4 => "mp4",
        }
    }

    /// The format for the extension of a path.
    ///
    /// # Errors
    /// [`VideoError::Extension`] if it is neither `.gif` nor `.mp4`.
    pub fn of(path: &Path) -> Result<Self, VideoError> {
        let extension = path.extension().map(|extension| extension.to_string_lossy());
        extension.and_then(|extension| Self::named(&extension)).ok_or(VideoError::Extension)
    }
}

/// Settings of a video.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Width and height (px). Both are even, as H.264 requires.
    pub size: [u32; 2],
    /// Frames per second, from 1 to 50. A GIF cannot show more.
    pub rate: u32,
    /// Simulated seconds per second of the video, greater than 0.
    pub speed: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self { size: [640, 480], rate: 30, speed: 10.0 }
    }
}

impl Settings {
    /// Simulated time (s) between two frames.
    pub(super) fn step(&self) -> f64 {
        self.speed / f64::from(self.rate)
    }
}
