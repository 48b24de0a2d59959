//! Any bytes as a compiled machine, as they are and with a header and a checksum that fit them: refused, or safe to run.
#![no_main]

#[path = "../../tests/policy/machine/artifact/erratic.rs"]
mod erratic;

use sha2::{Digest, Sha256};
use vibrissa_runtime::machine::{Artifact, FORMAT, MAGIC};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let length = u32::try_from(bytes.len()).unwrap_or(u32::MAX);
    let mut sealed = [&MAGIC[..], &FORMAT.to_le_bytes(), &length.to_le_bytes(), bytes].concat();
    let checksum = Sha256::digest(&sealed);
    sealed.extend(checksum);
    for bytes in [bytes, &sealed] {
        if let Ok(artifact) = Artifact::from_bytes(bytes) {
            erratic::run(artifact.program);
        }
    }
});
