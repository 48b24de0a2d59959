//! The options and the printed address of the live page.

use std::ffi::OsString;
use std::net::SocketAddr;
use std::path::PathBuf;

use clap::Args;

use super::failure::Failure;
use super::output;
use crate::live::{Live, LiveOptions, LiveWatcher, RunSetup};
use vibrissa_lab::load;
use vibrissa_text::file::CommandFiles;

/// The environment variable with the token of a page.
const TOKEN: &str = "VIBRISSA_LIVE_TOKEN";

/// The options of a live page.
#[derive(Debug, Args)]
pub(super) struct LivePage {
    /// Serve a page that shows the run while it happens. Without an address, only this machine can open it. Another address than
    /// 127.0.0.1 needs the token in the printed URL
    #[arg(long, value_name = "ADDRESS", num_args = 0..=1, require_equals = true, default_missing_value = "")]
    live: Option<String>,
    /// File with the token of the URL, at least 16 letters, digits, `-` and `_`. Without it, the environment variable
    /// `VIBRISSA_LIVE_TOKEN` is used. By default, the token is a random one where one is needed
    #[arg(long, value_name = "FILE", requires = "live")]
    live_token_file: Option<PathBuf>,
    /// Simulated seconds per second, or `max`. By default, runs are as fast as reality, and replays as fast as possible
    #[arg(long, value_name = "N|max", requires = "live", value_parser = parse_speed)]
    live_speed: Option<Speed>,
    /// Wait before the first tick until the page continues
    #[arg(long, requires = "live")]
    paused: bool,
}

/// The speed of a run that a page shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Speed {
    /// The ratio of simulated time to wall time.
    Times(f64),
    /// As fast as possible.
    Max,
}

impl Speed {
    fn ratio(self) -> Option<f64> {
        if let Self::Times(ratio) = self { Some(ratio) } else { None }
    }
}

fn parse_speed(text: &str) -> Result<Speed, String> {
    if text == "max" {
        return Ok(Speed::Max);
    }
    let ratio: Option<f64> = text.parse().ok();
    let ratio = ratio.filter(|ratio| (1e-3..=1e3).contains(ratio));
    ratio.map(Speed::Times).ok_or_else(|| "write a number from 0.001 to 1000, or max".to_owned())
}

impl LivePage {
    /// True if a page is asked for.
    pub(super) fn is_asked_for(&self) -> bool {
        self.live.is_some()
    }

    /// Begins to serve the page and prints its URL, if one is asked for. `breakpoints` are those of the command line.
    pub(super) fn start(&self, usual: Speed, breakpoints: &[String]) -> Result<Option<Live>, Failure> {
        let Some(address) = &self.live else { return Ok(None) };
        let options = LiveOptions {
            address: Some(address.clone()).filter(|address| !address.is_empty()),
            token: self.token()?,
            breakpoints: breakpoints.to_vec(),
            is_paused: self.paused,
            speed: self.live_speed.unwrap_or(usual).ratio(),
        };
        let live = Live::start(options)?;
        output::message(format_args!("live page: {}", live.url()));
        Ok(Some(live))
    }

    /// The token that the user gives. It is no option of its own, because every user of a machine can see the words of a command.
    fn token(&self) -> Result<Option<String>, Failure> {
        let Some(path) = &self.live_token_file else { return Ok(std::env::var(TOKEN).ok()) };
        let source = load::read(path, &mut CommandFiles::new())?;
        Ok(Some(source.text.trim().to_owned()))
    }
}

/// The speed of a simulated run without `--live-speed`.
pub(super) const REAL_TIME: Speed = Speed::Times(1.0);

/// Begins a run on the page. Breakpoints that its policy does not have are reported.
pub(super) fn begin<'i>(
    live: &Live,
    setup: RunSetup,
    is_over: impl FnMut() -> bool + 'i,
) -> Result<LiveWatcher<'i>, Failure> {
    let (watcher, faults) = live.begin(setup, is_over)?;
    for fault in faults {
        output::message(format_args!("warning: {fault}"));
    }
    Ok(watcher)
}

/// Serves the page until the user ends the program.
pub(super) fn serve_on(live: &Live) -> ! {
    output::message(format_args!("the page stays at {}; Ctrl-C ends", live.url()));
    live.serve_on()
}

/// Joins `--live` and an address after it, which may also be a separate argument.
pub(super) fn joined(arguments: impl Iterator<Item = OsString>) -> Vec<OsString> {
    let mut joined: Vec<OsString> = Vec::new();
    for argument in arguments {
        let is_address = argument.to_str().is_some_and(|text| text.parse::<SocketAddr>().is_ok());
        match joined.last_mut() {
            Some(last) if is_address && last == "--live" => {
                last.push("=");
                last.push(argument);
            }
            _ => joined.push(argument),
        }
    }
    joined
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_an_address_is_joined() {
        let words = |text: &str| joined(text.split(' ').map(Into::into)).join(" ".as_ref());
        assert_eq!(words("run --live 0.0.0.0:80 a.yaml"), "run --live=0.0.0.0:80 a.yaml");
        assert_eq!(words("run --live a.yaml"), "run --live a.yaml");
        assert_eq!(words("run a.yaml --live"), "run a.yaml --live");
        assert_eq!(words("run --out 0.0.0.0:80"), "run --out 0.0.0.0:80");
    }

    #[test]
    fn a_speed_is_a_ratio_or_max() {
        assert_eq!(parse_speed("2.5"), Ok(Speed::Times(2.5)));
        assert_eq!(parse_speed("max"), Ok(Speed::Max));
        assert!(["0", "-1", "nan", "inf", "fast", ""].iter().all(|text| parse_speed(text).is_err()));
    }
}
