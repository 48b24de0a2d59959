//! Emulated buses behind a socket.

use std::collections::BTreeMap;
use std::io::{Read, Write};
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Arc, Mutex, OnceLock};
use std::time::{Duration, Instant};

use embedded_hal::i2c::{I2c, Operation};
use vibrissa_mlx90393_emulator::{BusFault, EmulatedBus, EmulatedBusError, EmulatedSensor, SensorFault, SensorOptions};

type Field = fn(usize, u64) -> [f64; 3];
type Buses = Arc<Mutex<BTreeMap<u32, EmulatedBus<Field>>>>;

/// Two emulated buses, 1 and 3, with a sensor each.
pub(crate) struct Server {
    buses: Buses,
    pub(crate) socket: PathBuf,
}

impl Server {
    pub(crate) fn start() -> Self {
        let bus = |seed: u64| {
            let mut bus = EmulatedBus::new((|_, _| [0.0; 3]) as Field);
            bus.add(EmulatedSensor::new(SensorOptions {
                seed,
                noise_microtesla: [1.5; 3],
                ..SensorOptions::default()
            }));
            bus
        };
        let buses: Buses = Arc::new(Mutex::new(BTreeMap::from([(1, bus(1)), (3, bus(2))])));
        let socket = scratch().join(format!("bus-{:?}.socket", std::thread::current().id()));
        let _ = std::fs::remove_file(&socket);
        let listener = UnixListener::bind(&socket).unwrap();
        let (shared, start) = (Arc::clone(&buses), Instant::now());
        std::thread::spawn(move || {
            for stream in listener.incoming().map_while(Result::ok) {
                let shared = Arc::clone(&shared);
                std::thread::spawn(move || serve(stream, &shared, start));
            }
        });
        Self { buses, socket }
    }

    pub(crate) fn inject(&self, bus: u32, fault: BusFault) {
        self.buses.lock().unwrap().get_mut(&bus).unwrap().inject(fault);
    }

    pub(crate) fn clear(&self, bus: u32) {
        self.buses.lock().unwrap().get_mut(&bus).unwrap().clear();
    }

    pub(crate) fn inject_at(&self, bus: u32, address: u8, fault: SensorFault) {
        self.buses.lock().unwrap().get_mut(&bus).unwrap().inject_at(address, fault).unwrap();
    }

    pub(crate) fn clear_at(&self, bus: u32, address: u8) {
        self.buses.lock().unwrap().get_mut(&bus).unwrap().clear_at(address).unwrap();
    }
}

/// Serves one open bus until the program closes it. Emulated time is real time.
fn serve(mut stream: UnixStream, buses: &Buses, start: Instant) -> Option<()> {
    loop {
        let mut head = [0; 16];
        stream.read_exact(&mut head).ok()?;
        let word = |index: usize| u32::from_ne_bytes(head[4 * index..][..4].try_into().unwrap());
        let (number, address) = (word(0), u8::try_from(word(1)).ok()?);
        let mut written = vec![0; word(2) as usize];
        let mut read = vec![0; word(3) as usize];
        stream.read_exact(&mut written).ok()?;
        let (result, duration) = {
            let mut buses = buses.lock().unwrap();
            let bus = buses.get_mut(&number)?;
            let now_ns = u64::try_from(start.elapsed().as_nanos()).unwrap();
            bus.clock().advance_to_ns(now_ns);
            let before = bus.now_ns();
            let mut operations = Vec::new();
            if !written.is_empty() {
                operations.push(Operation::Write(&written));
            }
            if !read.is_empty() {
                operations.push(Operation::Read(&mut read));
            }
            let result = bus.transaction(address, &mut operations);
            (result, Duration::from_nanos(bus.now_ns() - before))
        };
        std::thread::sleep(duration);
        // The error numbers that Linux gives for these cases.
        let error: i32 = match result {
            Ok(()) => 0,
            Err(EmulatedBusError::NoAcknowledge { .. }) => 121,
            Err(EmulatedBusError::Timeout { .. }) => 110,
            Err(_) => 5,
        };
        stream.write_all(&error.to_ne_bytes()).ok()?;
        if error == 0 {
            stream.write_all(&read).ok()?;
        }
    }
}

/// The library that answers `/dev/i2c-N`, built once.
pub(crate) fn shim() -> &'static Path {
    static SHIM: OnceLock<PathBuf> = OnceLock::new();
    SHIM.get_or_init(|| {
        let library = scratch().join("shim.so");
        let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/system_bus/shim.c");
        let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".to_owned());
        let status = Command::new(compiler).args(["-shared", "-fPIC", "-O1", "-o"]).arg(&library).arg(source).status();
        assert!(status.unwrap().success(), "a C compiler is needed");
        library
    })
}

pub(crate) fn scratch() -> PathBuf {
    PathBuf::from(env!("CARGO_TARGET_TMPDIR"))
}
