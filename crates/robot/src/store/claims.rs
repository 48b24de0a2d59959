//! What a trusted comment says about its machine.

use super::verified_machine::Refusal;

/// What the trusted comment of a signature says about its machine: `robot:NAME`, the only robot for which it is, and
/// `counter:N`, which grows with every machine. Both are optional. `minisign -Sm FILE -t 'robot:array counter:7'` writes them.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Claims {
    /// The name of the robot.
    pub robot: Option<String>,
    /// The counter.
    pub counter: Option<u64>,
}

impl Claims {
    /// Reads a trusted comment. Other words in it mean nothing.
    ///
    /// # Errors
    /// [`Refusal::Claim`] if a claim occurs twice, or a counter is not a whole number.
    pub fn of(trusted_comment: &str) -> Result<Self, Refusal> {
        let mut claims = Self::default();
        for word in trusted_comment.split_whitespace() {
            let refused = || Refusal::Claim { word: word.to_owned() };
            if let Some(name) = word.strip_prefix("robot:") {
                let is_new = !name.is_empty() && claims.robot.replace(name.to_owned()).is_none();
                is_new.then_some(()).ok_or_else(refused)?;
            } else if let Some(counter) = word.strip_prefix("counter:") {
                let counter = counter.parse().map_err(|_| refused())?;
                let is_new = claims.counter.replace(counter).is_none();
                is_new.then_some(()).ok_or_else(refused)?;
            }
        }
        Ok(claims)
    }

    /// Returns an error if the machine is for another robot than the one with this name.
    ///
    /// # Errors
    /// [`Refusal::OtherRobot`].
    pub fn check_robot(&self, name: &str) -> Result<(), Refusal> {
        match &self.robot {
            Some(robot) if robot != name => Err(Refusal::OtherRobot { robot: robot.clone(), name: name.to_owned() }),
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use super::*;

    #[test]
    fn claims_are_words_of_the_trusted_comment() {
        let of = |comment| Claims::of(comment).ok().map(|claims| (claims.robot, claims.counter));
        let array = || Some("array".to_owned());
        assert_eq!(of("timestamp:1795851459\tfile:1.machine\thashed"), Some((None, None)));
        assert_eq!(of("robot:array counter:7"), Some((array(), Some(7))));
        assert_eq!(of("timestamp:1 counter:0\trobot:array thanks"), Some((array(), Some(0))));
        for damaged in [
            "counter:",
            "counter:-1",
            "counter:1.5",
            "counter:99999999999999999999",
            "robot:",
            "counter:1 counter:2",
            "robot:a robot:a",
        ] {
            assert_eq!(of(damaged), None, "{damaged}");
        }
    }
}
