//! The outputs that watch a run: its recording, its video, its window and its page.

#[cfg(feature = "render")]
use std::path::{Path, PathBuf};

#[cfg(any(feature = "render", feature = "viewer"))]
use clap::Args;
#[cfg(feature = "render")]
use indicatif::{ProgressBar, ProgressStyle};

use super::failure::Failure;
#[cfg(feature = "live")]
use super::live::{REAL_TIME, begin, serve_on};
use super::run::{Prepared, RunArguments};
#[cfg(feature = "render")]
use super::trials::extended;
use super::trials::run_with_bar;
#[cfg(feature = "render")]
use super::values::{parse_picture_size, parse_video_rate, parse_video_speed};
#[cfg(feature = "live")]
use crate::live::{Live, LiveWatcher, RunSetup};
#[cfg(feature = "viewer")]
use crate::video::RunWindow;
#[cfg(feature = "render")]
use crate::video::{Film, Format, Settings, Studio, VideoError};
#[cfg(feature = "recording")]
use vibrissa_lab::recording::Recorder;
#[cfg(feature = "render")]
use vibrissa_lab::trial::Trial;
use vibrissa_lab::trial::TrialResult;
use vibrissa_text::file::CommandFiles;
#[cfg(any(feature = "recording", feature = "render"))]
use vibrissa_text::file::Output;

/// The options of the video and of the window.
#[cfg(any(feature = "render", feature = "viewer"))]
#[derive(Debug, Args)]
pub(super) struct VideoOptions {
    /// Write a video of the run into this file, a .gif or an .mp4. With `gif` or `mp4` alone, a video of every run is written into the
    /// directory of `--out`. An .mp4 needs ffmpeg
    #[cfg(feature = "render")]
    #[arg(long, value_name = "FILE|gif|mp4", conflicts_with_all = ["watch", "transitions"])]
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

/// The outputs that watch runs. The recording and the window are for one run only.
pub(super) struct RunOutputs {
    #[cfg(feature = "recording")]
    record: Option<Output>,
    #[cfg(feature = "render")]
    video: Option<VideoOutputs>,
    #[cfg(feature = "viewer")]
    view: bool,
    #[cfg(feature = "live")]
    live: Option<Live>,
}

/// The videos of the runs.
#[cfg(feature = "render")]
struct VideoOutputs {
    format: Format,
    settings: Settings,
    /// The files of the runs that are still to come.
    files: std::vec::IntoIter<Output>,
}

impl RunOutputs {
    /// The first argument of an output of a whole run. `None` if there is none.
    pub(super) fn first_given(arguments: &RunArguments) -> Option<&'static str> {
        given(arguments).find_map(|(argument, is_given, _)| is_given.then_some(argument))
    }

    /// Requests the files for these runs, and begins to serve the page.
    pub(super) fn new(
        arguments: &RunArguments,
        prepared: &[Prepared],
        files: &mut CommandFiles,
    ) -> Result<Self, Failure> {
        let scenarios = prepared.len();
        if let Some((argument, ..)) = given(arguments).find(|&(_, is_given, is_of_one)| is_given && is_of_one)
            && scenarios > 1
        {
            return Err(Failure::OneRun { argument, scenarios });
        }
        #[cfg(not(any(feature = "recording", feature = "render")))]
        let _ = files;
        Ok(Self {
            #[cfg(feature = "recording")]
            record: arguments.record.as_ref().map(|path| files.output("--record", path)).transpose()?,
            #[cfg(feature = "render")]
            video: VideoOutputs::new(arguments, prepared, files)?,
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
        let (video, film) = self.video.as_mut().and_then(|videos| videos.next(trial)).transpose()?.unzip();
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
    Ok(file.write(recorder.finish(finished.ending().to_string(), &finished.run)?)?)
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
    let content = content.map_err(of_video(file.path()))?;
    Ok(file.write(content)?)
}

/// The watcher that shows a trial on a page.
#[cfg(feature = "live")]
fn page<'i>(prepared: &Prepared, live: &Live) -> Result<LiveWatcher<'i>, Failure> {
    begin(live, RunSetup::simulated(&prepared.trial, prepared.text.clone()), || false)
}

/// The outputs of whole runs, whether they are given, and whether each is for one run only.
fn given(arguments: &RunArguments) -> impl Iterator<Item = (&'static str, bool, bool)> {
    #[cfg(not(any(feature = "recording", feature = "render", feature = "viewer")))]
    let _ = arguments;
    [
        #[cfg(feature = "recording")]
        ("--record", arguments.record.is_some(), true),
        #[cfg(feature = "render")]
        ("--video", arguments.video.video.is_some(), false),
        #[cfg(feature = "viewer")]
        ("--view", arguments.video.view, true),
    ]
    .into_iter()
}

/// What draws a video of a run into its file, and what watches the run for it.
#[cfg(feature = "render")]
type Video = ((Output, Studio), Film);

#[cfg(feature = "render")]
impl VideoOutputs {
    fn new(arguments: &RunArguments, prepared: &[Prepared], files: &mut CommandFiles) -> Result<Option<Self>, Failure> {
        let VideoOptions { video, video_size: size, video_speed: speed, video_rate: rate, .. } = &arguments.video;
        let Some(path) = video else { return Ok(None) };
        let named = path.to_str().and_then(Format::named);
        let (format, paths) = if let Some(format) = named {
            let format_name = format.name();
            let Some(folder) = &arguments.out else { return Err(Failure::NoVideoFolder { format: format_name }) };
            let names = prepared.iter().map(|prepared| &prepared.trial.scene.name);
            (format, names.map(|name| extended(&folder.join(name), format_name)).collect())
        } else {
            let format = Format::of(path).map_err(of_video(path))?;
            let scenarios = prepared.len();
            if scenarios > 1 {
                return Err(Failure::OneVideo { path: path.clone(), format: format.name(), scenarios });
            }
            (format, vec![path.clone()])
        };
        let files = paths.iter().map(|path| files.output("--video", path)).collect::<Result<Vec<_>, _>>()?;
        let settings = Settings { size: *size, rate: *rate, speed: *speed };
        Ok(Some(Self { format, settings, files: files.into_iter() }))
    }

    /// The video of the next run.
    fn next(&mut self, trial: &Trial) -> Option<Result<Video, Failure>> {
        let file = self.files.next()?;
        let studio = Studio::new(&trial.scene, self.format, self.settings).map_err(of_video(file.path()));
        Some(studio.map(|studio| ((file, studio), Film::new(&self.settings))))
    }
}

/// The failure of the video at a path.
#[cfg(feature = "render")]
fn of_video(path: &Path) -> impl FnOnce(VideoError) -> Failure {
    let path = path.to_owned();
    |cause| Failure::Video { path, cause }
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
