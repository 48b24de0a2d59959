//! Messages of a broker in a file.

use vibrissa_robot::telemetry::{LineError, lines};

/// A file that has no message.
#[derive(Debug, thiserror::Error)]
pub enum MessagesError {
    /// A message is no telemetry of this version.
    #[error("line {number}: {cause}")]
    Message {
        /// Number of the line, from 1.
        number: usize,
        /// The reason.
        cause: LineError,
    },
    /// No line is a message.
    #[error(
        "no line begins with a time and a topic of Vibrissa; write the file by `mosquitto_sub -t 'vibrissa/#' -F '%U %t %p'`"
    )]
    Empty,
}

/// The points of all messages in a text, in the line protocol of InfluxDB. Each line of the text has the time of arrival in
/// seconds since 1970, the topic and the payload, as `mosquitto_sub -F '%U %t %p'` writes them. Other lines are parts of
/// packets, and are omitted.
///
/// # Errors
/// [`MessagesError`] if a message cannot be read, or if there is none.
pub fn lines_of_messages(text: &[u8]) -> Result<Vec<String>, MessagesError> {
    let (mut found, mut messages) = (Vec::new(), 0_usize);
    for (number, line) in (1..).zip(text.split(|&byte| byte == b'\n')) {
        let mut words = line.splitn(3, |&byte| byte == b' ');
        let mut word = || words.next().and_then(|word| std::str::from_utf8(word).ok());
        let (Some(Ok(time)), Some(topic)) = (word().map(str::parse::<f64>), word()) else { continue };
        if !topic.starts_with("vibrissa/") {
            continue;
        }
        messages += 1;
        let payload = words.next().unwrap_or_default();
        found.extend(lines(topic, payload, time).map_err(|cause| MessagesError::Message { number, cause })?);
    }
    if messages == 0 { Err(MessagesError::Empty) } else { Ok(found) }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use super::*;

    #[test]
    fn packets_between_messages_are_omitted_and_a_broken_message_has_its_line() {
        let text = b"1.5 vibrissa/array/status online\n2.0 vibrissa/array/command VBC1\x00\n\xff\xfe \n\n\
            3.0 vibrissa/array/sensor_io/status offline\n";
        assert_eq!(
            lines_of_messages(text).unwrap(),
            [
                "vibrissa_status,robot=array value=\"online\" 1500000000",
                "vibrissa_status,robot=array,service=sensor_io value=\"offline\" 3000000000"
            ]
        );
        let error = lines_of_messages(b"1.5 vibrissa/array/status online\n2 vibrissa/array/state {").unwrap_err();
        assert!(error.to_string().starts_with("line 2: "), "{error}");
        assert!(matches!(lines_of_messages(b"nothing\n"), Err(MessagesError::Empty)));
    }
}
