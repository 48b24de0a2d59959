//! The file of the running program.
#![expect(clippy::disallowed_methods, reason = "the system names the file")]

use std::fs::File;
use std::io::Read;

use sha2::{Digest, Sha256};

use crate::hex;

/// SHA-256 of the running program's file in hexadecimal digits. `None` if it cannot be read.
#[must_use]
pub fn program_sha256() -> Option<String> {
    let mut file = File::open(std::env::current_exe().ok()?).ok()?;
    let mut hash = Sha256::new();
    let mut buffer = vec![0; 1 << 16];
    loop {
        match file.read(&mut buffer).ok()? {
            0 => return Some(hex::encode(&hash.finalize())),
            count => hash.update(buffer.get(..count)?),
        }
    }
}
