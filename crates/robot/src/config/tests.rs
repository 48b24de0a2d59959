//! What a configuration is refused for, and at which place.

#![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "a test may panic and write files")]

use super::*;

/// The configuration of the documentation.
const ARRAY: &str = include_str!("../../../../deploy/pi/array.yaml");

/// The array with this text in place of another one, and the line of the change.
fn changed(from: &str, to: &str) -> (String, u64) {
    let (before, _) = ARRAY.split_once(from).unwrap_or_else(|| panic!("{from}"));
    (ARRAY.replacen(from, to, 1), before.matches('\n').count() as u64 + 1)
}

/// The line of the error and its message.
fn refusal(text: &str) -> (u64, String) {
    match Config::from_text(text) {
        Err(ConfigError::At { line, message, .. }) => (line, message),
        other => panic!("{other:?}"),
    }
}

/// Words of the YAML library and of the Rust language, and the other kind of file.
const FOREIGN: [&str; 11] =
    ["u8", "u64", "f64", "flattened", "Option", "String", "Policy", "Spanned", "struct", "deserialize", "scenario"];

fn expect(from: &str, to: &str, words: &str) {
    let (text, line) = changed(from, to);
    let (found, message) = refusal(&text);
    assert_eq!(found, line, "{to}: {message}");
    assert!(message.contains(words), "{to}: {message}");
    for word in FOREIGN {
        assert!(!message.contains(word), "{to}: {message}");
    }
}

#[test]
fn every_number_has_a_range_and_the_message_has_its_line() {
    for (from, to, words) in [
        ("speed: 0.1 m/s", "speed: -0.1 m/s", "`speed` cannot be -0.1 m/s; it must be from 1 mm/s to 100 m/s"),
        ("speed: 0.1 m/s", "speed: 0 m/s", "from 1 mm/s to 100 m/s"),
        ("speed: 0.1 m/s", "speed: 1e300 m/s", "from 1 mm/s to 100 m/s"),
        ("yaw_rate: 60 deg/s", "yaw_rate: -60 deg/s", "`yaw_rate` cannot be"),
        ("base_angle: 1050 urad", "base_angle: 0 urad", "`base_angle` cannot be"),
        ("base_angle: 1050 urad", "base_angle: 90 deg", "`base_angle` cannot be"),
        ("latency: 0 ms", "latency: 10 s", "`latency` cannot be 10 s; it must be from 0 s to 1 s"),
        ("latency: 0 ms", "latency: -10 ms", "`latency` cannot be"),
        ("clock: 360 kHz", "clock: 0 Hz", "`clock` cannot be"),
        ("clock: 360 kHz", "clock: 4000 kHz", "`clock` cannot be"),
        ("length: 75 mm", "length: 0 mm", "`length` cannot be 0"),
        ("length: 75 mm", "length: -75 mm", "from 1 mm to 1 m"),
        ("length: 75 mm", "length: 75 m", "from 1 mm to 1 m"),
        ("radius: 0.125 mm", "radius: 0.125 m", "`radius` cannot be"),
        ("base: [25 mm, -12 mm]", "base: [25 mm, -12 m]", "`base` cannot be"),
        ("direction: -105 deg", "direction: -1050 deg", "`direction` cannot be"),
        ("tail_width: 60 mm", "tail_width: 60 m", "`tail_width` cannot be"),
        ("nose_width: 6 mm", "nose_width: -6 mm", "`nose_width` cannot be"),
        ("centre_of_mass: 36 mm", "centre_of_mass: 36 m", "`centre_of_mass` cannot be"),
        ("centre_of_mass: 36 mm", "centre_of_mass: 1 m", "in front of the platform"),
        ("sample_rate: 300 Hz", "sample_rate: 0 Hz", "`sample_rate` cannot be"),
        ("control_rate: 30 Hz", "control_rate: -30 Hz", "`control_rate` cannot be"),
        ("filter_cutoff: 20 Hz", "filter_cutoff: 0 Hz", "`filter_cutoff` cannot be"),
        ("filter_cutoff: 20 Hz", "filter_cutoff: 200 Hz", "below half of the sample rate"),
        ("angle_noise: 0.5 urad", "angle_noise: -0.5 urad", "`angle_noise` cannot be"),
        ("base_angle: 1050 urad", "base_angle: 1e9 deg", "`base_angle` cannot be 1e9 deg; it must be"),
        ("gain: 7", "gain: 8", "`gain`: must be a whole number from 0 to 7, found `8`"),
        ("gain: 7", "gain: 300", "`gain`: must be a whole number from 0 to 7, found `300`"),
        ("gain: 7", "gain: high", "`gain`: must be a whole number from 0 to 7, found `high`"),
        ("resolution: 0", "resolution: 9", "`resolution`: must be a whole number from 0 to 3, found `9`"),
        ("oversampling: 2", "oversampling: 300", "`oversampling`: must be a whole number from 0 to 3, found `300`"),
        ("filter: 3", "filter: -1", "`filter`: must be a whole number from 0 to 7, found `-1`"),
        ("limit_mb: 1000", "limit_mb: 0", "`limit_mb` cannot be 0"),
        ("limit_mb: 1000", "limit_mb: -1", "`limit_mb`: must be a whole number"),
    ] {
        expect(from, to, words);
    }
    for key in ["bus", "sensor", "pose", "control", "link"] {
        for time in ["-1 s", "0 s", "1 h", "1e300 s"] {
            let (line, message) = refusal(&format!("{ARRAY}timeouts: {{{key}: {time}}}\n"));
            assert_eq!(line, ARRAY.matches('\n').count() as u64 + 1);
            assert!(message.contains(&format!("`{key}`")), "{time}: {message}");
        }
    }
    assert!(refusal(&format!("{ARRAY}timeouts: {{settle: -1 s}}\n")).1.contains("`settle` cannot be -1 s"));
    assert!(refusal(&format!("{ARRAY}mqtt: {{host: a, port: 0}}\n")).1.contains("`port` cannot be 0"));
    assert!(refusal(&format!("{ARRAY}mqtt: {{host: a, buffer: 0}}\n")).1.contains("`buffer` cannot be 0"));
}

#[test]
fn a_gain_that_makes_a_whisker_blind_is_refused() {
    let board = "{whisker: r0, address: 0x0C}";
    for gain in ["0", "0.0", "-0.0", "1e-300", "-1e300"] {
        let with = format!("{{whisker: r0, address: 0x0C, field_per_moment: {gain}}}");
        expect(board, &with, "`field_per_moment` cannot be");
    }
    for gain in [".nan", ".inf", "-.inf", "strong"] {
        let with = format!("{{whisker: r0, address: 0x0C, field_per_moment: {gain}}}");
        expect(board, &with, &format!("`field_per_moment`: must be a number, found `{gain}`"));
    }
    expect(board, "{whisker: r0, address: 0x0C, field_per_moment: 1e-4}", "so it is blind");
    expect(board, "{whisker: r0, address: 0x0C, cubic: .nan}", "`cubic`: must be a number");
    expect(board, "{whisker: r0, address: 0x0C, cubic: -1e6}", "turns back");
    // A board that is turned around, and a weak magnet.
    for gain in ["-4.38", "0.5"] {
        let with = format!("{{whisker: r0, address: 0x0C, field_per_moment: {gain}}}");
        Config::from_text(&changed(board, &with).0).unwrap();
    }
}

#[test]
fn a_very_small_number_is_told_without_its_zeros() {
    let board = "{whisker: r0, address: 0x0C}";
    let with = |value| format!("{{whisker: r0, address: 0x0C, field_per_moment: {value}}}");
    expect(board, &with("1e-300"), "cannot be 1e-300;");
    expect("speed: 0.1 m/s", "speed: 1e-300", "`1e-300` is not a speed");
    expect("gain: 7", "gain: 1e-300", "found `1e-300`");
}

#[test]
fn the_keys_of_a_pose_have_their_places_and_the_messages_their_names() {
    let sender = "udp: {listen: \"127.0.0.1:9751\"}, ";
    for (from, to, words) in [
        ("latency: 0 ms", "latncy: 0 ms", "there is no key `latncy`; did you mean `latency`?"),
        ("latency: 0 ms", "timeout: 9 ms", "there is no key `timeout`; the keys are `udp`, `mqtt`, `latency`"),
        ("latency: 0 ms", "latency: 3 kg", "`latency`: `3 kg` is not a time"),
        ("listen: \"127.0.0.1:9751\"", "listn: \"127.0.0.1:9751\"", "there is no key `listn`; did you mean `listen`?"),
        ("listen: \"127.0.0.1:9751\"", "listen: here", "`listen`: must be an IP address with a port"),
        (sender, "", "`pose`: has no source of poses; add `udp:"),
        (sender, "serial: {}, ", "there is no key `serial`; the keys are `udp`, `mqtt`"),
        (sender, &format!("{sender}mqtt: {{}}, "), "`pose`: has two sources of poses; keep either"),
        (sender, "udp: , ", "`udp`: the key `listen` is missing"),
        (sender, "mqtt: , ", "`pose` uses MQTT; add `mqtt: {host: ...}`"),
        (sender, "mqtt: {topic: pose}, ", "there is no key `topic`"),
    ] {
        expect(from, to, words);
    }
    // A key on its own line has that line.
    let (text, line) = changed("pose: {", "pose:\n  latncy: 3 ms\n  udp: {listen: \"127.0.0.1:9751\"}\nrest: {");
    assert_eq!(refusal(&text).0, line + 1);
}

#[test]
fn access_to_links_is_checked_before_the_start() {
    for (from, to, words) in [
        ("127.0.0.1:9750", "127.0.0.1:0", "`address` has the port 0"),
        ("127.0.0.1:9750", "0.0.0.0:9750", "`address` is 0.0.0.0, which names no computer"),
        ("127.0.0.1:9751", "127.0.0.1:0", "`listen` has the port 0"),
    ] {
        expect(from, to, words);
    }
    for (mqtt, words) in [
        ("tls: {ca: \"\"}", "`ca` is empty"),
        ("tls: {ca: \" \"}", "`ca` is empty"),
        ("user: \" \", password_file: /p", "`user` of `mqtt` is empty"),
        ("user: robot", "`mqtt` has a `user` and no `password_file`"),
        ("user: robot, password_file: \"\"", "`password_file` is empty"),
    ] {
        let (line, message) = refusal(&format!("{ARRAY}mqtt: {{host: a, {mqtt}}}\n"));
        assert_eq!(line, ARRAY.matches('\n').count() as u64 + 1);
        assert!(message.contains(words), "{message}");
    }
}

#[test]
fn a_device_that_is_listed_twice_is_refused_whatever_its_path() {
    for device in ["/dev/i2c-1", "/dev/./i2c-1", "//dev/i2c-1", "/dev/../dev/i2c-1", "/dev/bus/../i2c-1"] {
        expect("device: /dev/i2c-3", &format!("device: {device}"), "are one bus");
    }
    // Other names of one file.
    let folder = tempfile::tempdir().unwrap();
    let (device, link) = (folder.path().join("i2c-1"), folder.path().join("first-bus"));
    std::fs::write(&device, "").unwrap();
    std::os::unix::fs::symlink(&device, &link).unwrap();
    let text = ARRAY.replacen("/dev/i2c-1", device.to_str().unwrap(), 1);
    let text = text.replacen("/dev/i2c-3", link.to_str().unwrap(), 1);
    assert!(refusal(&text).1.contains("are one bus"));
}

#[test]
fn messages_have_the_words_of_the_configuration() {
    for (from, to, words) in [
        ("address: 0x0C", "address: 0C", "`address`: must be an address from 0x0C to 0x1B, found `0C`"),
        ("address: 0x0C", "address: 0x1C", "an MLX90393 has an address from 0x0C to 0x1B, not 0x1c"),
        ("address: 0x0C", "address: 256", "`address`: must be an address from 0x0C to 0x1B"),
        ("address: 0x0D", "address: 0x0C", "two boards on /dev/i2c-1 have the address 0x0c"),
        ("device: /dev/i2c-1", "device:", "`device`: must be a path, found nothing"),
        ("device: /dev/i2c-1", "device: \"\"", "`device` is empty"),
        ("device: /dev/i2c-1", "device: \" \"", "`device` is empty"),
        ("device: /dev/i2c-1", "device: [a]", "found a list"),
        ("gain: 7", "gain: 7.0", "`gain`: must be a whole number from 0 to 7, found `7.0`"),
        ("gain: 7", "gain: \"7\"", "`gain`: must be a whole number from 0 to 7, found the text `7`"),
        ("address: 0x0C", "address: \"0x0C\"", "found the text `0x0C`"),
        ("{udp: {address: \"127.0.0.1:9750\"}}", "udp", "must be keys with values, found the word alone"),
        (
            "{udp: {address: \"127.0.0.1:9750\"}}",
            "{}",
            "must be exactly one of `dry_run` or `udp` or `mqtt`, found no key",
        ),
        ("{udp: {address: \"127.0.0.1:9750\"}}", "{udp: , mqtt: }", "found `udp` and `mqtt`"),
        ("127.0.0.1:9750", "robot.local", "must be an IP address with a port"),
        ("speed: 0.1 m/s", "speed: 0.1", "`speed`: `0.1` is not a speed"),
        ("speed: 0.1 m/s", "speed: 0.1 kg", "`speed`: `0.1 kg` is not a speed"),
        ("speed: 0.1 m/s", "speed: fast", "`speed`:"),
        ("speed: 0.1 m/s", "speed: [0.1 m/s]", "`speed`: must be a text, found a list"),
        ("speed: 0.1 m/s, ", "speed: 0.1 m/s, speed: 9 m/s, ", "the key `speed` occurs twice"),
        ("speed: 0.1 m/s, ", "sped: 0.1 m/s, ", "did you mean `speed`?"),
        ("speed: 0.1 m/s, ", "", "the key `speed` is missing"),
        ("base: [25 mm, -12 mm]", "base: [25 mm]", "a point is two lengths, found 1 values"),
        ("udp: {address", "tcp: {address", "cannot be `tcp`"),
        ("name: array", "name: a/b", "`a/b` is not a name for a robot"),
        ("whisker: r0", "whisker: r9", "which the rig does not have"),
        ("r0: {base: [25 mm, -12 mm], ", "r0: {", "its `base`"),
    ] {
        if words == "its `base`" {
            // The reference rig has this whisker, so it has its base.
            Config::from_text(&changed(from, to).0).unwrap();
        } else {
            expect(from, to, words);
        }
    }
    expect("r2: {base: [-15 mm, -24 mm], ", "r2: {", "a whisker needs `base`");
    let (line, message) = refusal(&format!("{ARRAY}limits: {{speed: 9 m/s}}\n"));
    assert!(
        line > 40 && message.contains("the key `limits` occurs twice") && message.contains("remove one of them"),
        "{line}: {message}"
    );
    for (text, words) in [
        ("name: [", "not valid YAML"),
        ("- 1", "must be keys with values, found a list"),
        ("", "is missing"),
        ("name: a\n---\nname: b\n", "a second document"),
        ("name: *a\n", ""),
        ("name: a\nbuses: 3\nlimits: {}\npose: {}\n", "`buses`: must be a list, found `3`"),
        ("name: a\nbuses: []\nlimits: {}\npose: {}\n", "`limits`: the key `speed` is missing"),
    ] {
        let message = refusal(text).1;
        assert!(message.contains(words), "{text}: {message}");
        assert!(FOREIGN.iter().all(|word| !message.contains(word)), "{text}: {message}");
    }
}

#[test]
fn a_text_of_hostile_nesting_is_refused_quickly() {
    for text in ["[".repeat(100_000), "{a: ".repeat(50_000), format!("a: &a [{}]\n", "*a, ".repeat(1000))] {
        assert!(Config::from_text(&text).is_err());
    }
    assert_eq!(Config::from_text(&" ".repeat(CONFIG_LIMIT + 1)), Err(ConfigError::TooLarge));
}
