//! The protocol of 3-D printers: lines of G-code with a number and a checksum, each of which is answered by `ok`.

use std::path::Path;
use std::time::{Duration, Instant};

use super::error::StageError;
use super::port::Port;

/// How long a printer may take for its answer, beyond the time of a motion. One that is busy longer says so every two seconds.
const ANSWER: Duration = Duration::from_secs(5);
/// How long a board may take for its start, which opening the line causes on many.
const START: Duration = Duration::from_secs(10);
/// After this time without an answer, the first line is sent again.
const AGAIN: Duration = Duration::from_secs(1);
/// Time without a line after which everything that was sent before is here.
const SILENCE: Duration = Duration::from_millis(300);
/// How often a line is sent at most.
const ATTEMPTS: u32 = 4;
/// Largest distance (mm) from the position that was asked for: two of the last digits that printers tell.
const NEAR: f64 = 0.02;

/// A printer.
#[derive(Debug)]
pub(super) struct Printer {
    port: Port,
    /// Number of the last line.
    number: u32,
}

/// The end of an answer.
enum Answer {
    /// The line has been executed, or put into the queue of motions.
    Done,
    /// The printer waits for the line with this number.
    Resend(u32),
    /// There was no answer.
    Silent,
}

impl Printer {
    /// Connects to the printer, which may have to start first. Then sends the lines of `start`, millimetres and absolute positions.
    pub(super) fn connect(path: &Path, start: &[String]) -> Result<Self, StageError> {
        let port = Port::open(path).map_err(|cause| StageError::Open { path: path.to_owned(), cause })?;
        let mut printer = Self { port, number: 0 };
        printer.synchronise()?;
        for code in start.iter().map(String::as_str).chain(["G21", "G90"]) {
            printer.command(code, ANSWER)?;
        }
        Ok(printer)
    }

    /// Sets the number of lines, until the printer answers.
    fn synchronise(&mut self) -> Result<(), StageError> {
        let code = "M110 N0";
        let end = Instant::now() + START;
        while Instant::now() < end {
            self.port.send(&numbered(0, code)).map_err(StageError::Lost)?;
            let until = Instant::now() + AGAIN;
            while let Some(line) = self.port.line(until).map_err(StageError::Lost)? {
                if accepted(&line).is_some() {
                    // If it was only slow, it answers the other lines too.
                    return self.port.drain(SILENCE).map_err(StageError::Lost);
                }
            }
        }
        Err(StageError::Silent { code: code.to_owned(), seconds: START.as_secs() })
    }

    /// Sends a line until it is accepted, and gives what the printer has said besides.
    fn command(&mut self, code: &str, patience: Duration) -> Result<Vec<String>, StageError> {
        self.number += 1;
        let (mut said, mut is_silent) = (Vec::new(), false);
        for _ in 0..ATTEMPTS {
            self.port.send(&numbered(self.number, code)).map_err(StageError::Lost)?;
            match self.answer(code, patience, &mut said)? {
                Answer::Done => return Ok(said),
                Answer::Resend(asked) if asked == self.number => is_silent = false,
                // It has executed the line, whose `ok` was lost.
                Answer::Resend(asked) if asked == self.number + 1 => return Ok(said),
                Answer::Resend(asked) => return Err(StageError::Lines { asked, sent: self.number }),
                Answer::Silent => is_silent = true,
            }
        }
        let code = code.to_owned();
        Err(if is_silent {
            StageError::Silent { code, seconds: patience.as_secs() }
        } else {
            StageError::Noise { code, times: ATTEMPTS }
        })
    }

    /// The answer to a line. An error is final unless the printer asks for a line after it.
    fn answer(&mut self, code: &str, patience: Duration, said: &mut Vec<String>) -> Result<Answer, StageError> {
        let (mut error, mut resend) = (None, None);
        let mut until = Instant::now() + patience;
        loop {
            let line = self.port.line(until).map_err(StageError::Lost)?;
            let rest = match &line {
                Some(line) => accepted(line),
                None => Some(""),
            };
            if let Some(rest) = rest {
                said.push(rest.to_owned());
                return match (resend, error) {
                    (Some(asked), _) => Ok(Answer::Resend(asked)),
                    (None, Some(said)) => Err(StageError::Refused { code: code.to_owned(), said }),
                    (None, None) => Ok(if line.is_some() { Answer::Done } else { Answer::Silent }),
                };
            }
            let line = line.unwrap_or_default();
            if let Some(asked) = asked(&line) {
                resend = Some(asked);
            } else if line.starts_with("Error:") || line.starts_with("!!") {
                error.get_or_insert(line);
            } else if line == "start" {
                return Err(StageError::Restarted);
            } else if line.contains("busy:") {
                until = Instant::now() + patience;
            } else {
                said.push(line);
            }
        }
    }

    /// The position (mm) at the end of all motions.
    pub(super) fn position(&mut self) -> Result<[f64; 3], StageError> {
        // The answer to a line whose `ok` was lost may be lost too.
        for _ in 0..2 {
            let said = self.command("M114", ANSWER)?;
            if let Some(position) = said.iter().find_map(|line| position(line)) {
                return Ok(position);
            }
        }
        Err(StageError::NoPosition)
    }

    /// Moves along a straight line, waits for the end of the motion, and checks the position. Positions are in mm, the speed in mm/s.
    pub(super) fn go(&mut self, [x, y, z]: [f64; 3], speed: f64, distance: f64) -> Result<(), StageError> {
        self.command(&format!("G1 X{x:.3} Y{y:.3} Z{z:.3} F{:.0}", 60.0 * speed), ANSWER)?;
        // Twice the time of the motion, because the printer has a limit of its own for each axis.
        self.command("M400", ANSWER + Duration::from_secs_f64(2.0 * distance / speed))?;
        let (asked, found) = ([x, y, z], self.position()?);
        let is_there = asked.iter().zip(found).all(|(asked, found)| (asked - found).abs() <= NEAR);
        if is_there { Ok(()) } else { Err(StageError::Elsewhere { asked, found }) }
    }
}

/// A line with its number and its checksum.
fn numbered(number: u32, code: &str) -> String {
    let line = format!("N{number} {code}");
    format!("{line}*{}", line.bytes().fold(0, |sum, byte| sum ^ byte))
}

/// What follows the `ok` of a line, if it is one.
fn accepted(line: &str) -> Option<&str> {
    line.strip_prefix("ok").filter(|rest| rest.is_empty() || rest.starts_with(' '))
}

/// The number of the line that the printer asks for.
fn asked(line: &str) -> Option<u32> {
    let rest = line.strip_prefix("Resend:").or_else(|| line.strip_prefix("rs "))?;
    rest.trim().trim_start_matches('N').split_whitespace().next()?.parse().ok()
}

/// The position in a line such as `X:10.00 Y:20.00 Z:5.00 E:0.00 Count X:800 Y:1600 Z:2000`.
fn position(line: &str) -> Option<[f64; 3]> {
    let line = line.split("Count").next()?;
    let along = |axis: &str| {
        let number = line.split_once(axis)?.1.split_whitespace().next()?;
        number.parse().ok().filter(|number: &f64| number.is_finite())
    };
    Some([along("X:")?, along("Y:")?, along("Z:")?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_checksum_is_that_of_other_programs() {
        // From the documentation of the protocol.
        assert_eq!(numbered(0, "M110 N0"), "N0 M110 N0*125");
        assert_eq!(numbered(3, "T0"), "N3 T0*57");
    }

    #[test]
    fn answers_of_several_firmwares_are_understood() {
        assert_eq!(position("X:10.00 Y:-20.50 Z:5.00 E:0.00 Count X:800 Y:1600 Z:2000"), Some([10.0, -20.5, 5.0]));
        assert_eq!(position(" C: X:1.0 Y: 2.0 Z:3.0"), Some([1.0, 2.0, 3.0]));
        assert_eq!(position("T:21.4 /0.0 B:20.9"), None);
        assert_eq!((asked("Resend: 7"), asked("rs N7"), asked("Resent")), (Some(7), Some(7), None));
        assert_eq!((accepted("ok"), accepted("ok P15 B3"), accepted("okay")), (Some(""), Some(" P15 B3"), None));
    }
}
