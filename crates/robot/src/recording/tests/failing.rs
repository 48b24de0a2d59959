//! Outputs that fail.

use std::collections::BTreeMap;
use std::io::{Error, ErrorKind, Result, Write};

use vibrissa_runtime::machine::Artifact;
use vibrissa_runtime::rig::Rig;

use crate::config::Config;
use crate::drive::LoopRecord;
use crate::link::CommandPacket;
use crate::recording::{Origin, RecordingWriter, Setup, WriteError};
use vibrissa_runtime::signal::Command;

/// An output that takes a limited number of bytes.
struct Full(usize);

impl Write for Full {
    fn write(&mut self, bytes: &[u8]) -> Result<usize> {
        match self.0.min(bytes.len()) {
            0 => Err(Error::from(ErrorKind::StorageFull)),
            count => {
                self.0 -= count;
                Ok(count)
            }
        }
    }

    fn flush(&mut self) -> Result<()> {
        Ok(())
    }
}

#[test]
fn a_disk_that_is_full_at_any_byte_is_an_error_and_no_panic() {
    let machine = include_bytes!("../../../../runtime/fixtures/bang.machine");
    let setup =
        Setup::new(Config::emulated(Rig::default(), 1.5), None, Artifact::from_bytes(machine).unwrap()).unwrap();
    let origin = Origin { program: "test".to_owned(), program_sha256: None, details: BTreeMap::new() };
    let write = |room: usize| {
        let mut writer = RecordingWriter::new(Full(room), &setup, &origin)?;
        for sequence in 1..5000 {
            let packet = CommandPacket { sequence, time_ns: 10 * sequence, command: Command::STOP, is_stop: true };
            writer.take(&LoopRecord::Packet(packet))?;
        }
        writer.finish().map(|output| output.0)
    };
    let size = usize::MAX - write(usize::MAX).unwrap();
    assert!(size > 10_000);
    for room in (0..size).step_by(size / 200) {
        assert!(matches!(write(room), Err(WriteError::Disk(_))), "{room} of {size} bytes");
    }
    assert_eq!(write(size).unwrap(), 0);
}
