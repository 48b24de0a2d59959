//! Errors of videos.

use vibrissa_text::system::in_words;

use vibrissa_mujoco::visual::RenderError;

/// A video that cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum VideoError {
    /// The extension of the file is not that of a format.
    #[error("its name has no known format; end its name in .gif or .mp4, or write only gif or mp4 together with --out")]
    Extension,
    /// The pictures cannot be drawn.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The run had no tick.
    #[error("the run ended before its first tick, so there is nothing to show")]
    Empty,
    /// The video would have too many frames.
    #[error("it would have {frames} frames, and {most} are the most; raise --video-speed, or lower --video-rate")]
    TooLong {
        /// The number of frames.
        frames: usize,
        /// The largest number.
        most: usize,
    },
    /// The GIF cannot be encoded.
    #[error("the GIF cannot be encoded: {0}")]
    Gif(#[from] gif::EncodingError),
    /// ffmpeg is missing.
    #[error("MP4 needs the program ffmpeg, which cannot be started ({words}); install it, or write a .gif", words = in_words(.0))]
    NoFfmpeg(std::io::Error),
    /// ffmpeg ended with an error.
    #[error("ffmpeg could not encode the video: {0}; it needs the encoder libx264, or write a .gif")]
    Ffmpeg(String),
}
