//! MP4 by the program ffmpeg.

use std::io::{Read, Write};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::thread::JoinHandle;
use vibrissa_text::system::in_words;

use super::error::VideoError;
use super::settings::Settings;

/// The program.
const PROGRAM: &str = "ffmpeg";
/// The most bytes of its messages that are reported.
const MOST_MESSAGES: usize = 400;

/// A running ffmpeg. It receives raw pictures, and its output is collected.
pub(super) struct Mp4Encoder {
    child: Child,
    /// `None` after the last picture.
    pictures: Option<ChildStdin>,
    output: Option<JoinHandle<Vec<u8>>>,
    messages: Option<JoinHandle<Vec<u8>>>,
}

impl Mp4Encoder {
    /// Starts ffmpeg.
    ///
    /// # Errors
    /// [`VideoError::NoFfmpeg`] if it does not start.
    pub(super) fn start(settings: &Settings) -> Result<Self, VideoError> {
        let [width, height] = settings.size;
        let (size, rate) = (format!("{width}x{height}"), settings.rate.to_string());
        let mut command = Command::new(PROGRAM);
        command.args(["-nostdin", "-loglevel", "error"]);
        command.args(["-f", "rawvideo", "-pixel_format", "rgb24", "-video_size", &size, "-framerate", &rate]);
        command.args(["-i", "pipe:0", "-an", "-c:v", "libx264", "-crf", "20"]);
        // Most players show only this kind of pixels.
        command.args(["-pix_fmt", "yuv420p"]);
        // A pipe cannot be rewound to write the table of frames, so every part has its own.
        command.args(["-movflags", "frag_keyframe+empty_moov+default_base_moof", "-f", "mp4", "pipe:1"]);
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().map_err(VideoError::NoFfmpeg)?;
        let pictures = child.stdin.take();
        let output = child.stdout.take().map(collected).transpose().map_err(VideoError::NoFfmpeg)?;
        let messages = child.stderr.take().map(collected).transpose().map_err(VideoError::NoFfmpeg)?;
        Ok(Self { child, pictures, output, messages })
    }

    pub(super) fn add(&mut self, picture: &[u8]) -> Result<(), VideoError> {
        let Some(pictures) = &mut self.pictures else { return Err(self.failure()) };
        // If ffmpeg has ended, its messages say why.
        pictures.write_all(picture).map_err(|_| self.failure())
    }

    pub(super) fn finish(mut self) -> Result<Vec<u8>, VideoError> {
        self.pictures = None;
        let output = self.output.take().and_then(|output| output.join().ok());
        match (self.child.wait(), output) {
            (Ok(status), Some(output)) if status.success() && !output.is_empty() => Ok(output),
            _ => Err(self.failure()),
        }
    }

    /// Waits for the end of ffmpeg, and returns its messages.
    fn failure(&mut self) -> VideoError {
        self.pictures = None;
        let status = self.child.wait();
        let messages = self.messages.take().and_then(|messages| messages.join().ok()).unwrap_or_default();
        let messages = String::from_utf8_lossy(&messages);
        let messages: String = messages.trim().chars().take(MOST_MESSAGES).collect();
        VideoError::Ffmpeg(if messages.is_empty() {
            status.map_or_else(|error| in_words(&error), |status| status.to_string())
        } else {
            messages.replace('\n', ", ")
        })
    }
}

impl Drop for Mp4Encoder {
    fn drop(&mut self) {
        // Without its last picture the output is of no use. After `finish` the process has ended.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Collects everything that a process writes.
fn collected(mut stream: impl Read + Send + 'static) -> std::io::Result<JoinHandle<Vec<u8>>> {
    std::thread::Builder::new().spawn(move || {
        let mut bytes = Vec::new();
        // After an error, what came before it is enough for a message.
        let _ = stream.read_to_end(&mut bytes);
        bytes
    })
}
