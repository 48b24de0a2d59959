//! The commands that a microcontroller executes: packets of `vibrissa-robot`, in their order, and only young ones.
//!
//! It needs neither `std` nor an allocator. All times are those of the microcontroller's own clock, in nanoseconds.

/// Length of a packet.
const LENGTH: usize = 49;
/// Age after which a command is not executed any more, and after which a sender may have started again. The robot's timeout `control` is as long.
const OLDEST_NS: u64 = 70_000_000;
/// A number that is farther ahead is none of the sequence.
const LARGEST_STEP: u64 = 1 << 32;
/// Time after which the shortest delay is measured anew, because clocks drift apart.
const MEMORY_NS: u64 = 30_000_000_000;

/// A motion in the world frame: velocity of the centre of mass (m/s) and yaw rate (rad/s).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    pub x: f64,
    pub y: f64,
    pub yaw_rate: f64,
}

impl Motion {
    /// No motion.
    pub const STOP: Self = Self { x: 0.0, y: 0.0, yaw_rate: 0.0 };
}

/// The command that holds, and what is known of its sender.
#[derive(Debug)]
pub struct Commands {
    motion: Motion,
    until_ns: u64,
    last: Option<u64>,
    /// Numbers out of order that grow: the last one, and the time of the first one.
    run: Option<(u64, u64)>,
    /// The shortest delays of the time before and since `began_ns`.
    shortest: [Option<i128>; 2],
    began_ns: u64,
}

impl Commands {
    /// Before the first command.
    pub const fn new() -> Self {
        Self { motion: Motion::STOP, until_ns: 0, last: None, run: None, shortest: [None, None], began_ns: 0 }
    }

    /// Takes a packet from `vibrissa/NAME/sensor_io/command`. The result is the acknowledgement, or `None` if the packet is not executed.
    pub fn take(&mut self, packet: &[u8], now_ns: u64) -> Option<[u8; 12]> {
        let word = |at: usize| packet.get(at..)?.first_chunk().copied().map(u64::from_le_bytes);
        if packet.len() != LENGTH || !packet.starts_with(b"VBC1") {
            return None;
        }
        let (number, sent_ns) = (word(4)?, word(12)?);
        let [x, y, yaw_rate] = [word(20)?, word(28)?, word(36)?].map(f64::from_bits);
        let is_stop = match packet.get(44)? {
            0 => false,
            1 => true,
            _ => return None,
        };
        let valid_ms = u32::from_le_bytes(*packet.get(45..)?.first_chunk()?);
        let is_finite = x.is_finite() && y.is_finite() && yaw_rate.is_finite();
        if !is_finite || !self.is_in_order(number, sent_ns, now_ns) {
            return None;
        }
        let age_ns = self.age_ns(sent_ns, now_ns);
        // A stop is executed at any age.
        if age_ns > OLDEST_NS && !is_stop {
            return None;
        }
        self.motion = if is_stop { Motion::STOP } else { Motion { x, y, yaw_rate } };
        self.until_ns = (now_ns + u64::from(valid_ms) * 1_000_000).saturating_sub(age_ns);
        let mut acknowledgement = [0; 12];
        for (byte, value) in acknowledgement.iter_mut().zip(b"VBA1".iter().copied().chain(number.to_le_bytes())) {
            *byte = value;
        }
        Some(acknowledgement)
    }

    /// The motion of the motors at this time. It is a stop when the time in the newest packet is over.
    pub fn motion(&self, now_ns: u64) -> Motion {
        if now_ns < self.until_ns { self.motion } else { Motion::STOP }
    }

    /// True for a number that follows the last one. A sender that has started again is followed after it has sent for a while, but the
    /// packet that shows this is not executed.
    fn is_in_order(&mut self, number: u64, sent_ns: u64, now_ns: u64) -> bool {
        let follows = |last: u64| number > last && number - last <= LARGEST_STEP;
        if self.last.is_none_or(follows) {
            (self.last, self.run) = (Some(number), None);
            return true;
        }
        let began_ns = self.run.filter(|(last, _)| follows(*last)).map_or(now_ns, |(_, began_ns)| began_ns);
        self.run = Some((number, began_ns));
        if now_ns.saturating_sub(began_ns) > OLDEST_NS {
            (self.last, self.run) = (Some(number), None);
            (self.shortest, self.began_ns) = ([None, None], 0);
            self.age_ns(sent_ns, now_ns);
        }
        false
    }

    /// The delay beyond the shortest one, because the sender has another clock.
    fn age_ns(&mut self, sent_ns: u64, now_ns: u64) -> u64 {
        if now_ns.saturating_sub(self.began_ns) >= MEMORY_NS {
            (self.shortest, self.began_ns) = ([self.shortest[1], None], now_ns);
        }
        let delay = i128::from(now_ns) - i128::from(sent_ns);
        let since = self.shortest[1].map_or(delay, |since| since.min(delay));
        self.shortest[1] = Some(since);
        let shortest = self.shortest[0].map_or(since, |before| before.min(since));
        u64::try_from(delay - shortest).unwrap_or(u64::MAX)
    }
}
