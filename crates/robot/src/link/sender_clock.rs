//! The age of packets whose sender has another clock.

/// Time (ns) after which the shortest delay is forgotten, at the latest after twice of it. Clocks drift apart by less than a
/// millisecond meanwhile, and a computer that was suspended is understood again.
const MEMORY_NS: u64 = 30_000_000_000;

/// Estimates the age of packets. Their sender writes the time of its own clock into them. The packet with the shortest delay is
/// taken as new, and every other one is older by what its delay exceeds this.
#[derive(Debug, Clone, Default)]
pub(crate) struct SenderClock {
    /// The shortest differences (ns) between arrival and sending: of the time before, and since `begun_ns`. The clocks begin at
    /// different times, so they can be negative.
    shortest: [Option<i128>; 2],
    begun_ns: u64,
}

impl SenderClock {
    /// The age (ns) of a packet that was sent at `sent_ns` of the sender's clock and arrives at `now_ns`.
    pub(crate) fn age_ns(&mut self, sent_ns: u64, now_ns: u64) -> u64 {
        if now_ns.saturating_sub(self.begun_ns) >= MEMORY_NS {
            self.shortest = [self.shortest[1], None];
            self.begun_ns = now_ns;
        }
        let delay = i128::from(now_ns) - i128::from(sent_ns);
        let [before, since] = self.shortest;
        let since = since.map_or(delay, |since| since.min(delay));
        self.shortest[1] = Some(since);
        let shortest = before.map_or(since, |before| before.min(since));
        u64::try_from(delay - shortest).unwrap_or(u64::MAX)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: u64 = 1_000_000;

    #[test]
    fn the_age_is_the_delay_beyond_the_shortest_whichever_clock_began_first() {
        for offset in [0, 77_000 * MS, u64::MAX / 2] {
            let mut clock = SenderClock::default();
            let ages = [(0, 5), (10, 13), (20, 3023), (30, 33), (40, 140)];
            let ages = ages.map(|(sent, now)| clock.age_ns(offset + sent * MS, (50 + now) * MS) / MS);
            assert_eq!(ages, [0, 0, 3000, 0, 97]);
        }
    }

    #[test]
    fn a_clock_that_drifts_is_followed_and_one_wrong_time_is_forgotten() {
        let mut clock = SenderClock::default();
        clock.age_ns(u64::MAX, 0);
        let mut age = u64::MAX;
        for step in 0..360_000 {
            // 100 ppm slower, over an hour.
            let sent = step * 10 * MS;
            age = clock.age_ns(sent - sent / 10_000, sent);
        }
        assert!(age < 10 * MS, "{age}");
    }
}
