//! The outputs that watch a run: its recording, its video, its window and its page.

#[cfg(feature = "render")]
use std::path::PathBuf;

#[cfg(any(feature = "render", feature = "viewer"))]
use clap::Args;
#[cfg(feature = "render")]
use indicatif::{ProgressBar, ProgressStyle};

use super::failure::Failure;
#[cfg(feature = "live")]
use super::live::{REAL_TIME, begin, serve_on};
use super::run::{Prepared, RunArguments};
use super::trials::run_with_bar;
#[cfg(feature = "render")]
use super::values::{parse_picture_size, parse_video_rate, parse_video_speed};
#[cfg(feature = "live")]
use crate::live::{Live, LiveWatcher, RunSetup};
#[cfg(feature = "viewer")]
use crate::video::RunWindow;
#[cfg(feature = "render")]
use crate::video::{Film, Format, Settings, Studio};
#[cfg(feature = "recording")]
use vibrissa_lab::recording::Recorder;
#[cfg(feature = "render")]
use vibrissa_lab::trial::Trial;
use vibrissa_lab::trial::TrialResult;
use vibrissa_text::file::CommandFiles;
#[cfg(any(feature = "recording", feature = "render"))]
use vibrissa_text::file::Output;
#[cfg(feature = "render")]
use vibrissa_world::scene::Scene;

/// The options of the video and of the window.
#[cfg(any(feature = "render", feature = "viewer"))]
#[derive(Debug, Args)]
pub(super) struct VideoOptions {
    /// Write a video of the run into this file, a .gif or an .mp4. An .mp4 needs ffmpeg. With one scenario
    #[cfg(feature = "render")]
    #[arg(long, value_name = "FILE", conflicts_with_all = ["watch", "transitions"])]
    video: Option<PathBuf>,
    /// Width and height of the video in pixels, even numbers from 64 to 4096
    #[cfg(feature = "render")]
    #[arg(long, value_name = "WxH", requires = "video", value_parser = parse_picture_size, default_value = "640x480")]
    video_size: [u32; 2],
    /// Simulated seconds per second of the video, from 0.01 to 1000
    #[cfg(feature = "render")]
    #[arg(long, value_name = "X", requires = "video", allow_negative_numbers = true, value_parser = parse_video_speed, default_value = "10")]
    video_speed: f64,
    /// Frames per second of the video, from 1 to 50
    #[cfg(feature = "render")]
    #[arg(long, value_name = "N", requires = "video", allow_negative_numbers = true, value_parser = parse_video_rate, default_value = "30")]
    video_rate: u32,
    /// Show the run in a window, in real time. The space bar pauses it. With one scenario
    #[cfg(feature = "viewer")]
    #[arg(long, conflicts_with_all = ["watch", "transitions"])]
    #[cfg_attr(feature = "live", arg(conflicts_with = "live"))]
    view: bool,
}

/// The outputs that watch runs. All but the page are for one run only.
pub(super) struct RunOutputs {
    #[cfg(feature = "recording")]
    record: Option<Output>,
    #[cfg(feature = "render")]
    video: Option<VideoOutput>,
    #[cfg(feature = "viewer")]
    view: bool,
    #[cfg(feature = "live")]
    live: Option<Live>,
}

#[cfg(feature = "render")]
struct VideoOutput {
    file: Output,
    format: Format,
    settings: Settings,
}

impl RunOutputs {
    /// The first argument of an output that is for one run. `None` if there is none.
    pub(super) fn first_given(arguments: &RunArguments) -> Option<&'static str> {
        given(arguments).find_map(|(argument, is_given)| is_given.then_some(argument))
    }

    /// Requests the files, and begins to serve the page.
    pub(super) fn new(arguments: &RunArguments, files: &mut CommandFiles) -> Result<Self, Failure> {
        if let Some(argument) = Self::first_given(arguments)
            && arguments.scenarios.len() > 1
        {
            return Err(Failure::OneRun { argument, scenarios: arguments.scenarios.len() });
        }
        #[cfg(not(any(feature = "recording", feature = "render")))]
        let _ = files;
        Ok(Self {
            #[cfg(feature = "recording")]
            record: arguments.record.as_ref().map(|path| files.output("--record", path)).transpose()?,
            #[cfg(feature = "render")]
            video: VideoOutput::new(&arguments.video, files)?,
            #[cfg(feature = "viewer")]
            view: arguments.video.view,
            #[cfg(feature = "live")]
            live: arguments.live.start(REAL_TIME, &arguments.inspection.breakpoints)?,
        })
    }

    /// Runs a trial with its outputs, and writes them. A failure of an output does not stop the other ones, and the result of the run
    /// is returned beside it.
    #[cfg_attr(
        not(any(feature = "recording", feature = "render", feature = "viewer", feature = "live")),
        expect(clippy::unused_self, reason = "this build has none of these outputs")
    )]
    pub(super) fn run(&mut self, prepared: &Prepared) -> Result<(TrialResult, Result<(), Failure>), Failure> {
        let trial = &prepared.trial;
        // Missing programs and drivers are reported before the run.
        #[cfg(feature = "render")]
        let (video, film) = self.video.take().map(|video| video.studio(&trial.scene)).transpose()?.unzip();
        #[cfg(not(feature = "render"))]
        let film = ();
        #[cfg(feature = "recording")]
        let (record, recorder) = self.record.take().map(|file| recorder(prepared, file)).transpose()?.unzip();
        #[cfg(not(feature = "recording"))]
        let recorder = ();
        #[cfg(feature = "viewer")]
        let window = self.view.then(|| RunWindow::open(&trial.scene)).transpose()?;
        #[cfg(not(feature = "viewer"))]
        let window = ();
        #[cfg(feature = "live")]
        let page = self.live.as_ref().map(|live| page(prepared, live)).transpose()?;
        #[cfg(not(feature = "live"))]
        let page = ();
        let mut watchers = ((recorder, film), (window, page));
        let finished = run_with_bar(trial, &mut watchers)?;
        #[cfg(feature = "live")]
        if let Some(page) = watchers.1.1 {
            page.finish(&finished);
        }
        let written = Ok(());
        #[cfg(feature = "recording")]
        let written = written.and(write_recording(record.zip(watchers.0.0), &finished));
        #[cfg(feature = "render")]
        let written = written.and(write_video(video.zip(watchers.0.1), trial, &finished));
        #[cfg(feature = "viewer")]
        let written = written.and(watchers.1.0.map_or(Ok(()), |window| Ok(window.close()?)));
        Ok((finished, written))
    }

    /// Serves the page, if there is one, until the user ends the program.
    #[cfg_attr(not(feature = "live"), expect(clippy::unused_self, reason = "this build has no page"))]
    pub(super) fn serve_on(&self) {
        #[cfg(feature = "live")]
        if let Some(live) = &self.live {
            serve_on(live);
        }
    }
}

/// The watcher that records a trial into a file.
#[cfg(feature = "recording")]
fn recorder(prepared: &Prepared, file: Output) -> Result<(Output, Recorder), Failure> {
    let Prepared { trial, text, artifact } = prepared;
    Ok((file, Recorder::new(trial, artifact, text.clone())?))
}

#[cfg(feature = "recording")]
fn write_recording(recording: Option<(Output, Recorder)>, finished: &TrialResult) -> Result<(), Failure> {
    let Some((file, recorder)) = recording else { return Ok(()) };
    Ok(file.write(recorder.finish(finished)?)?)
}

#[cfg(feature = "render")]
fn write_video(video: Option<((Output, Studio), Film)>, trial: &Trial, finished: &TrialResult) -> Result<(), Failure> {
    let Some(((file, studio), film)) = video else { return Ok(()) };
    let bar = frames_bar();
    let progress = |done: usize, all: usize| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
    };
    let content = studio.develop(&trial.scene, &film, &finished.run.trace, progress);
    bar.finish_and_clear();
    Ok(file.write(content?)?)
}

/// The watcher that shows a trial on a page.
#[cfg(feature = "live")]
fn page<'i>(prepared: &Prepared, live: &Live) -> Result<LiveWatcher<'i>, Failure> {
    begin(live, RunSetup::simulated(&prepared.trial, prepared.text.clone()), || false)
}

/// The outputs that are for one run, and whether they are given.
fn given(arguments: &RunArguments) -> impl Iterator<Item = (&'static str, bool)> {
    #[cfg(not(any(feature = "recording", feature = "render", feature = "viewer")))]
    let _ = arguments;
    [
        #[cfg(feature = "recording")]
        ("--record", arguments.record.is_some()),
        #[cfg(feature = "render")]
        ("--video", arguments.video.video.is_some()),
        #[cfg(feature = "viewer")]
        ("--view", arguments.video.view),
    ]
    .into_iter()
}

#[cfg(feature = "render")]
impl VideoOutput {
    fn new(options: &VideoOptions, files: &mut CommandFiles) -> Result<Option<Self>, Failure> {
        let VideoOptions { video, video_size: size, video_speed: speed, video_rate: rate, .. } = options;
        let Some(path) = video else { return Ok(None) };
        let format = Format::of(path)?;
        let settings = Settings { size: *size, rate: *rate, speed: *speed };
        Ok(Some(Self { file: files.output("--video", path)?, format, settings }))
    }

    /// What draws the video after the run, and what watches the run for it.
    fn studio(self, scene: &Scene) -> Result<((Output, Studio), Film), Failure> {
        let studio = Studio::new(scene, self.format, self.settings)?;
        Ok(((self.file, studio), Film::new(&self.settings)))
    }
}

/// The progress of a video's frames on standard error, if that is a terminal.
#[cfg(feature = "render")]
fn frames_bar() -> ProgressBar {
    let bar = ProgressBar::new(0);
    if let Ok(style) = ProgressStyle::with_template("video {wide_bar} {pos} of {len} frames, {elapsed}") {
        bar.set_style(style);
    }
    bar
}
