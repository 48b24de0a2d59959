//! Sending a machine to a robot.

use std::ffi::{OsStr, OsString};
use std::io;
use std::process::Command;
use std::time::Duration;
use vibrissa_text::system::in_words;

use super::answer::Answer;
use super::machine_hash::MachineHash;
use super::process::{self, Ended};
use super::signed_machine::SignedMachine;
use super::text::one_line;

/// The default time for a push. Most of it is for a person who types a password.
const TIMEOUT: Duration = Duration::from_mins(1);
/// Longest text of the robot in a message, in characters.
const TEXT_LIMIT: usize = 1000;
/// Exit status of ssh if it has no connection.
const NO_CONNECTION: i32 = 255;
/// Exit status of a shell that does not find the program.
const NO_PROGRAM: i32 = 127;

/// The command that transports a push.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PushCommand {
    /// The program.
    pub program: OsString,
    /// Its arguments.
    pub arguments: Vec<OsString>,
    /// The time that it has. It is killed afterwards.
    pub timeout: Duration,
}

/// An error of a push.
#[derive(Debug, thiserror::Error)]
pub enum PushError {
    /// The program cannot be started or watched.
    #[error("cannot run {}: {words}; install it, or name another program", program.display(), words = in_words(cause))]
    Start {
        /// The program.
        program: OsString,
        /// The cause.
        cause: io::Error,
    },
    /// The program did not end in time.
    #[error(
        "the robot has not answered within {} s, so it may have taken the machine or not; check the connection, and push the \
         machine again, which is safe", timeout.as_secs_f64()
    )]
    Timeout {
        /// The time that the program had.
        timeout: Duration,
    },
    /// There is no connection, or it broke.
    #[error(
        "the connection to the robot failed ({text}); if it broke during the push, the robot has the machine or not; check \
         that `ssh HOST` works, and push the machine again, which is safe"
    )]
    Connection {
        /// The text of the program.
        text: String,
    },
    /// The robot does not have the program.
    #[error(
        "the robot does not find the program that receives ({text}); install it on the robot, in a folder of its PATH"
    )]
    NoProgram {
        /// The text of the shell.
        text: String,
    },
    /// The robot refused the machine.
    #[error("the robot did not take the machine: {text}")]
    Refused {
        /// The text of the robot. It says what to do.
        text: String,
    },
    /// The answer cannot be read.
    #[error("the answer of the robot is not understood ({text}); use the same version on both computers")]
    Answer {
        /// The text of the robot.
        text: String,
    },
    /// The answer is about another machine.
    #[error("the robot took the machine {answered}, but {sent} was sent; push the machine again")]
    OtherMachine {
        /// The machine that was sent.
        sent: MachineHash,
        /// The machine in the answer.
        answered: MachineHash,
    },
}

impl PushCommand {
    /// Runs `vibrissa-robot receive` on `host` through ssh. The host is a name of ssh, such as `vibrissa@robot`.
    #[must_use]
    pub fn ssh(host: &str) -> Self {
        // No host is taken for an option after `--`.
        Self::new("ssh", &["-T", "-o", "ConnectTimeout=10", "--", host, "vibrissa-robot", "receive"])
    }

    /// Runs another program in place of ssh. Its arguments are the host and the command for the robot.
    #[must_use]
    pub fn via(program: &OsStr, host: &str) -> Self {
        Self::new(program, &[host, "vibrissa-robot", "receive"])
    }

    fn new(program: impl Into<OsString>, arguments: &[&str]) -> Self {
        Self { program: program.into(), arguments: arguments.iter().map(Into::into).collect(), timeout: TIMEOUT }
    }
}

/// Sends a machine to a robot and waits for the answer.
///
/// The robot verifies the signature. Verify it before with [`Keys::verify`](super::Keys::verify), if the public key is there.
/// Pushing the same machine again is harmless.
///
/// # Errors
/// [`PushError`]. Only after some of the errors can the robot have taken the machine. Their messages say so.
pub fn push(by: &PushCommand, machine: &SignedMachine) -> Result<Answer, PushError> {
    let start = |cause| PushError::Start { program: by.program.clone(), cause };
    let mut input = Vec::new();
    machine.write_frame(&mut input).map_err(start)?;
    let mut command = Command::new(&by.program);
    command.args(&by.arguments);
    let ended = process::run(command, input, by.timeout).map_err(start)?;
    let Ended { status, output, errors } = ended.ok_or(PushError::Timeout { timeout: by.timeout })?;
    let text = one_line(&[errors.as_str(), output.as_str()].join(" "), TEXT_LIMIT);
    let text = if text.is_empty() { status.to_string() } else { text };
    match status.code() {
        Some(0) => {}
        Some(NO_PROGRAM) => return Err(PushError::NoProgram { text }),
        // Without a code, a signal has ended it.
        Some(NO_CONNECTION) | None => return Err(PushError::Connection { text }),
        Some(_) => return Err(PushError::Refused { text }),
    }
    // A login script may have printed lines before.
    let line = output.lines().rev().find(|line| !line.trim().is_empty());
    let answer = line.and_then(Answer::from_line).ok_or(PushError::Answer { text })?;
    if answer.hash == machine.hash() {
        Ok(answer)
    } else {
        Err(PushError::OtherMachine { sent: machine.hash(), answered: answer.hash })
    }
}
