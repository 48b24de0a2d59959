//! `run --video`. Most of these tests need EGL with a driver, which may be one in software. Without it they are skipped, except in CI.
#![allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "pixels of a picture")]

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::Arc;

use gif::{ColorOutput, DecodeOptions};
use nalgebra::{Isometry3, Perspective3, Point3, Vector3};
use serde_json::Value;
use vibrissa::diagnostic::Source;
use vibrissa::mujoco::visual::{Camera, RenderError};
use vibrissa::scene::{Scene, WorldKind};
use vibrissa::trial::{Trial, TrialResult};
use vibrissa::video::{Film, Format, Settings, Studio, VideoError};
use vibrissa::{policy, scenario};

use super::program::{ROOT, directory, stderr, stdout, vibrissa};

/// A scene of this length (s).
fn scene(seconds: f64) -> String {
    format!(
        "name: scene\nworld: quasistatic\nobjects: [{{circle: {{centre: [40 cm, 40 cm], radius: 30 cm}}}}]\n\
         start: {{position: [0 mm, 72 mm], heading: 90 deg}}\nstop: {{time: {seconds} s}}\n"
    )
}

/// True where OpenGL without a window can be opened.
pub(crate) fn can_draw() -> bool {
    let scene = scenario::read(&Source::new("scene.yaml", scene(1.0))).unwrap();
    match Studio::new(&scene, Format::Gif, Settings::default()) {
        Err(VideoError::Render(RenderError::NoContext(reason))) => {
            let is_ci = std::env::var_os("CI").is_some_and(|ci| !ci.is_empty());
            assert!(!is_ci, "CI needs the Debian packages libegl1, libgl1 and libgl1-mesa-dri: {reason}");
            false
        }
        studio => studio.map(|_| true).unwrap(),
    }
}

/// A folder with a scene of this length (s).
fn folder(name: &str, seconds: f64) -> PathBuf {
    let folder = directory(name);
    fs::write(folder.join("scene.yaml"), scene(seconds)).unwrap();
    folder
}

/// `vibrissa run` of the scene in a folder, with further words, in which `@` stands for the folder.
fn run(folder: &Path, words: &str) -> Output {
    let line = format!("run @/scene.yaml --policy policies/bang.fsm {words}");
    let words: Vec<_> = line.split_whitespace().map(|word| word.replace('@', folder.to_str().unwrap())).collect();
    vibrissa(&words.iter().map(String::as_str).collect::<Vec<_>>())
}

/// A GIF as a viewer shows it.
struct Shown {
    size: [usize; 2],
    pictures: Vec<Vec<[u8; 3]>>,
    /// Seconds.
    length: f64,
}

fn shown(bytes: &[u8]) -> Shown {
    let mut options = DecodeOptions::new();
    options.set_color_output(ColorOutput::RGBA);
    let mut decoder = options.read_info(bytes).unwrap();
    let size = [decoder.width(), decoder.height()].map(usize::from);
    let mut canvas = vec![[0; 3]; size[0] * size[1]];
    let (mut pictures, mut length) = (Vec::new(), 0.0);
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        for (at, pixel) in frame.buffer.chunks_exact(4).enumerate() {
            let (row, column) = (at / usize::from(frame.width), at % usize::from(frame.width));
            if pixel[3] > 0 {
                canvas[(row + usize::from(frame.top)) * size[0] + column + usize::from(frame.left)] =
                    [pixel[0], pixel[1], pixel[2]];
            }
        }
        pictures.push(canvas.clone());
        length += f64::from(frame.delay) / 100.0;
    }
    Shown { size, pictures, length }
}

#[test]
fn a_gif_has_the_size_the_rate_and_the_speed_that_were_asked_for() {
    if !can_draw() {
        return;
    }
    let folder = folder("video-size", 6.0);
    let output = run(&folder, "--video @/run.gif --video-size 128x96 --video-speed 4 --video-rate 20");
    assert!(matches!(output.status.code(), Some(0 | 1)), "{}", stderr(&output));
    let Shown { size, pictures, length } = shown(&fs::read(folder.join("run.gif")).unwrap());
    assert_eq!(size, [128, 96]);
    // One frame at the start, one after each 0.2 s, and the end of the run.
    assert!((30..=31).contains(&pictures.len()), "{} frames", pictures.len());
    assert!((length - pictures.len() as f64 / 20.0).abs() < 0.011, "{length} s");
    let changes = pictures.windows(2).filter(|pair| pair[0] != pair[1]).count();
    assert!(changes > 25, "the platform moves in {changes} frames");
    assert!(pictures.first() != pictures.last());
}

#[test]
fn slow_motion_repeats_pictures_instead_of_inventing_them() {
    if !can_draw() {
        return;
    }
    let folder = folder("video-slow", 0.5);
    let output = run(&folder, "--video @/run.gif --video-size 64x64 --video-speed 0.25 --video-rate 50");
    assert!(matches!(output.status.code(), Some(0 | 1)), "{}", stderr(&output));
    let Shown { pictures, length, .. } = shown(&fs::read(folder.join("run.gif")).unwrap());
    // From the first tick to the end of the run, at a quarter of the speed.
    assert!((length - 4.0 * 0.5).abs() < 0.2, "{length} s");
    let different = 1 + pictures.windows(2).filter(|pair| pair[0] != pair[1]).count();
    assert!(different <= 15, "there are 15 ticks, and {different} pictures");
}

/// A trial, its result, and its video.
fn filmed(scene: Scene, policy_file: &str, settings: Settings) -> (Trial, TrialResult, Shown, Camera) {
    let text = fs::read_to_string(Path::new(ROOT).join(policy_file)).unwrap();
    let program = policy::compile(&Source::new(policy_file, text)).unwrap();
    let trial = Trial::new(scene, Arc::new(program));
    let studio = Studio::new(&trial.scene, Format::Gif, settings).unwrap();
    let mut film = Film::new(&settings);
    let result = trial.run_watched(&mut film).unwrap();
    let camera = studio.camera(&trial.scene, &film);
    let video = studio.develop(&trial.scene, &film, &result.run.trace, |_, _| ()).unwrap();
    (trial, result, shown(&video), camera)
}

/// The pixel at which a pinhole camera sees a point, by the matrices of nalgebra.
fn pixel(camera: &Camera, [width, height]: [usize; 2], point: Point3<f64>) -> [f64; 2] {
    let view = Isometry3::look_at_rh(&camera.position, &camera.looks_at, &Vector3::z());
    let aspect = width as f64 / height as f64;
    let seen = Perspective3::new(aspect, camera.field_of_view, 0.01, 100.0).project_point(&(view * point));
    [0.5 * (1.0 + seen.x) * width as f64, 0.5 * (1.0 - seen.y) * height as f64]
}

/// True if a pixel within `reach` of a place is nearer to this colour than `tolerance`.
fn has_colour(shown: &Shown, picture: usize, [x, y]: [f64; 2], reach: f64, colour: [u8; 3], tolerance: u8) -> bool {
    let [width, height] = shown.size;
    let span =
        |at: f64, most: usize| ((at - reach).floor().max(0.0) as usize)..=((at + reach).ceil() as usize).min(most - 1);
    span(y, height).any(|row| {
        span(x, width).any(|column| {
            let pixel = shown.pictures[picture][row * width + column];
            pixel.iter().zip(colour).all(|(part, wanted)| part.abs_diff(wanted) <= tolerance)
        })
    })
}

/// The colour of the first whisker of a trace in reports.
const FIRST: [u8; 3] = [0x00, 0x72, 0xb2];
const SECOND: [u8; 3] = [0xe6, 0x9f, 0x00];
/// The colour of the platform in this light.
const PLATFORM: [u8; 3] = [0x4b, 0x59, 0x65];

#[test]
fn whiskers_and_contours_are_where_the_trace_says() {
    if !can_draw() {
        return;
    }
    for kind in [WorldKind::QuasiStatic, WorldKind::Mujoco] {
        let mut scene = scenario::read(&Source::new("scene.yaml", scene(12.0))).unwrap();
        scene.world = Some(kind);
        let settings = Settings { size: [640, 480], rate: 10, speed: 10.0 };
        let (trial, result, shown, camera) = filmed(scene, "policies/thesis.fsm", settings);
        let trace = &result.run.trace;
        let (last, picture) = (trace.ticks.last().unwrap(), shown.pictures.len() - 1);
        let place = |x: f64, y: f64, z: f64| pixel(&camera, shown.size, Point3::new(x, y, z));
        for (name, end, colour) in [
            (&trace.whiskers[0], last.whiskers[0].tip_end.unwrap(), FIRST),
            (&trace.whiskers[1], last.whiskers[1].tip_end.unwrap(), SECOND),
        ] {
            assert!(has_colour(&shown, picture, place(end.x, end.y, 0.0), 2.0, colour, 24), "{kind}: tip of {name}");
            let whisker = trial.scene.rig.whiskers.iter().find(|whisker| whisker.name == *name).unwrap();
            let base = last.body.point_to_world(whisker.base_body);
            // Near its base, a shaft has the direction in which it is mounted.
            let near = base + 0.2 * (end - base);
            assert!(
                has_colour(&shown, picture, place(near.x, near.y, 0.0), 3.0, colour, 24),
                "{kind}: shaft of {name}"
            );
        }
        // The contour is drawn above the objects, which are 20 mm high.
        let recorded: Vec<_> = trace.tips(0).chain(trace.tips(1)).collect();
        assert!(recorded.len() > 50, "{} recorded tips", recorded.len());
        let is_drawn = |tip: vibrissa::geometry::Point2| {
            let at = place(tip.x, tip.y, 0.011);
            has_colour(&shown, picture, at, 2.0, FIRST, 24) || has_colour(&shown, picture, at, 2.0, SECOND, 24)
        };
        let drawn = recorded.iter().filter(|(_, tip)| is_drawn(*tip)).count();
        assert!(drawn as f64 > 0.97 * recorded.len() as f64, "{kind}: {drawn} of {}", recorded.len());
        // No contour is there before it was recorded.
        let whiskers: usize =
            shown.pictures[0].iter().filter(|pixel| pixel.iter().zip(FIRST).all(|(a, b)| a.abs_diff(b) <= 24)).count();
        let later: usize = shown.pictures[picture]
            .iter()
            .filter(|pixel| pixel.iter().zip(FIRST).all(|(a, b)| a.abs_diff(b) <= 24))
            .count();
        let other: usize = shown.pictures[picture]
            .iter()
            .filter(|pixel| pixel.iter().zip(SECOND).all(|(a, b)| a.abs_diff(b) <= 24))
            .count();
        assert!(later.max(other) > 2 * whiskers, "{kind}: {later} and {other} pixels after {whiskers}");
        // The platform is dark, at its true pose.
        let middle = place(last.body.position.x, last.body.position.y, 0.01);
        // Its path is a line above it.
        assert!(has_colour(&shown, picture, middle, 4.0, PLATFORM, 30), "{kind}: the platform at {middle:?}");
    }
}

#[test]
fn a_video_changes_nothing_of_the_run_and_a_recording_may_be_made_beside_it() {
    if !can_draw() {
        return;
    }
    let folder = folder("video-same", 4.0);
    let document = |words: &str| {
        let output = run(&folder, &format!("--json {words}"));
        assert!(matches!(output.status.code(), Some(0 | 1)), "{}", stderr(&output));
        let mut document: Value = serde_json::from_str(&stdout(&output)).unwrap();
        let run = document[0].as_object_mut().unwrap();
        // The times that computers need differ.
        run.retain(|key, _| {
            !key.contains("wall")
                && !key.contains("_us")
                && !key.contains("start")
                && key != "realtime"
                && key != "provenance"
        });
        document
    };
    let plain = document("");
    assert_eq!(document("--video @/run.gif --video-size 64x64"), plain);
    #[cfg(feature = "recording")]
    {
        assert_eq!(document("--video @/both.gif --video-size 64x64 --record @/run.mcap"), plain);
        assert_eq!(fs::read(folder.join("both.gif")).unwrap(), fs::read(folder.join("run.gif")).unwrap());
        assert!(folder.join("run.mcap").exists());
    }
}

#[test]
fn the_same_run_gives_the_same_gif() {
    if !can_draw() {
        return;
    }
    let folder = folder("video-again", 3.0);
    let gif = |name: &str| {
        let output = run(&folder, &format!("--video @/{name} --video-size 160x120"));
        assert!(matches!(output.status.code(), Some(0 | 1)), "{}", stderr(&output));
        fs::read(folder.join(name)).unwrap()
    };
    assert_eq!(gif("first.gif"), gif("second.gif"));
}

#[test]
fn a_run_that_fails_has_a_video_until_its_failure() {
    if !can_draw() {
        return;
    }
    let folder = folder("video-failed", 6.0);
    let machine = "machine quick  whisker r0  initial Going\n\
        state Going { steer r0 along vector(1, 0) at 5 cm/s turning 0 deg/s  after 1 s -> Failure(\"over\") }\n";
    fs::write(folder.join("quick.fsm"), machine).unwrap();
    let path = |name: &str| folder.join(name).display().to_string();
    let words =
        ["run", &path("scene.yaml"), "--policy", &path("quick.fsm"), "--video", &path("run.gif"), "--video-speed", "1"];
    let output = vibrissa(&words);
    assert!(stderr(&output).contains("over"), "{}", stderr(&output));
    let Shown { length, .. } = shown(&fs::read(folder.join("run.gif")).unwrap());
    assert!((0.9..1.2).contains(&length), "{length} s");
}

/// What is refused is refused before the run: nothing is printed, and there is no file.
#[test]
fn what_cannot_be_written_is_refused_before_the_run() {
    let folder = folder("video-refused", 6.0);
    fs::create_dir(folder.join("folder.gif")).unwrap();
    for (words, wanted) in [
        ("--video @/run.avi", "end its name in .gif or .mp4"),
        ("--video @/run", "end its name in .gif or .mp4"),
        ("--video @/folder.gif", "another path with --video"),
        ("--video @/run.gif --out @ --ticks @/run.gif", "another path with"),
        ("--video @/run.gif --video-size 641x480", "two even numbers from 64 to 4096"),
        ("--video @/run.gif --video-size 640", "two even numbers from 64 to 4096"),
        ("--video @/run.gif --video-size 8x8", "two even numbers from 64 to 4096"),
        ("--video @/run.gif --video-rate 60", "a whole number from 1 to 50"),
        ("--video @/run.gif --video-speed 0", "a number from 0.01 to 1000"),
        ("--video @/run.gif --video-speed -1", "a number from 0.01 to 1000"),
        ("--video @/run.gif --video-speed nan", "a number from 0.01 to 1000"),
        ("--video-size 64x64", "--video <FILE|gif|mp4>"),
        ("--video @/run.gif --watch", "cannot be used with"),
        (
            "--video @/run.gif scenarios/disk.yaml",
            "write --video gif --out DIR for a video of each, or give one scenario",
        ),
        ("--video gif", "add --out DIR, or name a file such as run.gif"),
        ("--video mp4 scenarios/disk.yaml", "add --out DIR, or name a file such as run.mp4"),
        ("--video gif --out @/scene.yaml", "scene.yaml"),
        ("--video gif --out @/out @/scene.yaml", "have the same name `scene`"),
    ] {
        let refused = run(&folder, words);
        assert_eq!(refused.status.code(), Some(2), "{words}: {}", stderr(&refused));
        assert!(stderr(&refused).contains(wanted), "{words}: {}", stderr(&refused));
        assert_eq!(stdout(&refused), "", "{words}");
        assert!(!folder.join("run.gif").exists(), "{words}");
    }
}

/// As the pictures of `--out`, each video has the name of its scenario.
#[test]
fn several_runs_have_a_video_each_in_the_folder_of_their_reports() {
    if !can_draw() {
        return;
    }
    let folder = folder("video-several", 1.0);
    fs::write(folder.join("other.yaml"), scene(2.0).replace("name: scene", "name: turn-90")).unwrap();
    let words = "@/other.yaml --out @/out --video-size 64x64 --video-rate 20 --video-speed 1";
    let output = run(&folder, &format!("{words} --video gif"));
    assert!(matches!(output.status.code(), Some(0 | 1)), "{}", stderr(&output));
    let of = |name: &str| fs::read(folder.join("out").join(name)).unwrap();
    let lengths = ["scene.gif", "turn-90.gif"].map(|name| shown(&of(name)).length);
    assert!((0.9..1.2).contains(&lengths[0]) && (1.9..2.2).contains(&lengths[1]), "{lengths:?}");
    for name in ["scene.svg", "turn-90.svg", "index.html"] {
        assert!(folder.join("out").join(name).exists(), "{name}");
    }
    // One of them alone is the same.
    let alone = run(&folder, &format!("--video @/alone.gif {}", &words["@/other.yaml --out @/out".len()..]));
    assert!(matches!(alone.status.code(), Some(0 | 1)), "{}", stderr(&alone));
    assert_eq!(fs::read(folder.join("alone.gif")).unwrap(), of("scene.gif"));
    // A GIF needs no ffmpeg, and the lack of it is told before the first run.
    for (format, status) in [("gif", 0), ("mp4", 2)] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_vibrissa"));
        command.arg("run").arg(folder.join("scene.yaml")).arg(folder.join("other.yaml"));
        command.args(["--policy", "policies/bang.fsm", "--video", format, "--video-size", "64x64", "--out"]);
        let output = command.arg(folder.join(format)).current_dir(ROOT).env("PATH", "/nonexistent").output().unwrap();
        let code = output.status.code().map(|code| if code == 1 { 0 } else { code });
        assert_eq!(code, Some(status), "{}", stderr(&output));
        assert_eq!(folder.join(format).join(format!("turn-90.{format}")).exists(), status == 0);
        assert_eq!(stdout(&output).is_empty(), status == 2);
        assert_eq!(stderr(&output).contains("install it, or write a .gif"), status == 2, "{}", stderr(&output));
    }
}

/// Each video that fails is told with its file, and costs no other one.
#[test]
fn a_video_that_fails_costs_no_other_one() {
    let folder = with_ffmpeg("video-each", "echo 'no space' >&2; exit 1");
    if !can_draw() {
        return;
    }
    fs::write(folder.join("other.yaml"), scene(2.0).replace("name: scene", "name: other")).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_vibrissa"));
    command.arg("run").arg(folder.join("scene.yaml")).arg(folder.join("other.yaml"));
    command.args(["--policy", "policies/bang.fsm", "--video", "mp4", "--video-size", "64x64", "--out"]);
    let path = format!("{}:/usr/bin:/bin", folder.display());
    let output = command.arg(folder.join("out")).current_dir(ROOT).env("PATH", path).output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    for wanted in ["scene.mp4: ffmpeg could not", "other.mp4: ffmpeg could not"] {
        assert!(stderr(&output).contains(wanted), "{wanted}: {}", stderr(&output));
    }
    assert!(stdout(&output).contains("other"), "the results of the runs are not lost");
}

#[test]
fn a_missing_folder_is_told_and_leaves_no_file() {
    let folder = folder("video-nowhere", 1.0);
    let output = run(&folder, "--video @/missing/run.gif --video-size 64x64");
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("another path with --video"), "{}", stderr(&output));
    assert!(!folder.join("missing").exists());
}

/// `vibrissa run --video` with further variables of the environment.
fn run_with(folder: &Path, name: &str, variables: &[(&str, &str)]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_vibrissa"));
    command.arg("run").arg(folder.join("scene.yaml")).args(["--policy", "policies/bang.fsm", "--video"]);
    command.arg(folder.join(name)).args(["--video-size", "64x64"]);
    command.current_dir(ROOT).envs(variables.iter().copied()).output().unwrap()
}

#[test]
fn without_a_driver_for_opengl_the_packages_are_named_before_the_run() {
    let folder = folder("video-no-egl", 6.0);
    // The library of EGL asks this list for its drivers.
    let output = run_with(&folder, "run.gif", &[("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent.json")]);
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    for wanted in ["OpenGL without a window is not available", "libegl1", "libgl1-mesa-dri"] {
        assert!(stderr(&output).contains(wanted), "{wanted}: {}", stderr(&output));
    }
    assert!(stdout(&output).is_empty() && !folder.join("run.gif").exists());
}

/// A folder with a program of the name ffmpeg.
fn with_ffmpeg(name: &str, script: &str) -> PathBuf {
    let folder = folder(name, 2.0);
    let program = folder.join("ffmpeg");
    fs::write(&program, format!("#!/bin/sh\n{script}\n")).unwrap();
    fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
    folder
}

#[test]
fn ffmpeg_receives_every_picture_and_its_output_is_the_file() {
    if !can_draw() {
        return;
    }
    let folder = with_ffmpeg("video-ffmpeg", "echo \"$@\" > \"$(dirname \"$0\")/words\"; cat | wc -c");
    let output = run_with(&folder, "run.mp4", &[("PATH", &format!("{}:/usr/bin:/bin", folder.display()))]);
    assert!(matches!(output.status.code(), Some(0 | 1)), "{}", stderr(&output));
    let words = fs::read_to_string(folder.join("words")).unwrap();
    for wanted in ["-pixel_format rgb24", "-video_size 64x64", "-framerate 30", "-pix_fmt yuv420p", "libx264"] {
        assert!(words.contains(wanted), "{wanted}: {words}");
    }
    let bytes: usize = fs::read_to_string(folder.join("run.mp4")).unwrap().trim().parse().unwrap();
    // Two seconds at ten times the speed are six frames and the last one.
    let frames = bytes / (3 * 64 * 64);
    assert!(bytes == frames * 3 * 64 * 64 && (6..=7).contains(&frames), "{bytes} bytes");
}

#[test]
fn an_ffmpeg_that_fails_or_is_missing_is_told_with_what_to_do() {
    if !can_draw() {
        return;
    }
    let folder = with_ffmpeg("video-bad-ffmpeg", "echo 'Unknown encoder libx264' >&2; exit 1");
    let output = run_with(&folder, "run.mp4", &[("PATH", &format!("{}:/usr/bin:/bin", folder.display()))]);
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    assert!(stderr(&output).contains("Unknown encoder libx264"), "{}", stderr(&output));
    assert!(stdout(&output).contains("scene"), "the result of the run is not lost");
    let output = run_with(&folder, "run.mp4", &[("PATH", "/nonexistent")]);
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    assert!(stderr(&output).contains("install it, or write a .gif"), "{}", stderr(&output));
    assert!(stdout(&output).is_empty() && !folder.join("run.mp4").exists());
}

/// Where there is ffmpeg, it decodes what it has encoded.
#[test]
fn an_mp4_has_the_frames_of_the_run() {
    let folder = folder("video-mp4", 6.0);
    let has_ffmpeg = Command::new("ffmpeg").arg("-version").output().is_ok();
    assert!(has_ffmpeg || std::env::var_os("VIBRISSA_TEST_FFMPEG").is_none(), "install the Debian package ffmpeg");
    if !has_ffmpeg || !can_draw() {
        return;
    }
    let words = "--video @/run.mp4 --video-size 128x96 --video-speed 4 --video-rate 20";
    let output = run(&folder, words);
    assert!(matches!(output.status.code(), Some(0 | 1)), "{}", stderr(&output));
    let mut decoder = Command::new("ffmpeg");
    decoder.args(["-loglevel", "error", "-i"]).arg(folder.join("run.mp4"));
    let decoded = decoder.args(["-f", "rawvideo", "-pix_fmt", "rgb24", "pipe:1"]).output().unwrap();
    assert!(decoded.status.success(), "{}", stderr(&decoded));
    let frames = decoded.stdout.len() / (3 * 128 * 96);
    assert_eq!(decoded.stdout.len(), frames * 3 * 128 * 96);
    run(&folder, &words.replace("mp4", "gif"));
    let gif = shown(&fs::read(folder.join("run.gif")).unwrap());
    assert_eq!(frames, gif.pictures.len());
    let last = &decoded.stdout[(frames - 1) * 3 * 128 * 96..];
    let difference = last.iter().zip(gif.pictures[frames - 1].iter().flatten()).map(|(a, b)| f64::from(a.abs_diff(*b)));
    let mean = difference.sum::<f64>() / last.len() as f64;
    assert!(mean < 6.0, "the last pictures differ by {mean} of 255 on average");
}
