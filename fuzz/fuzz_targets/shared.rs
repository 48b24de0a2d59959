//! Policies whose parts share others exponentially, from any seed and mutated by any bytes: answered.
#![no_main]

#[path = "../../tests/policy_robustness/answered.rs"]
mod answered;
#[path = "../../tests/policy/machine/artifact/erratic.rs"]
mod erratic;
#[path = "../../tests/policy_robustness/random.rs"]
mod random;
#[path = "../../tests/policy_robustness/shared.rs"]
mod shared;

libfuzzer_sys::fuzz_target!(|input: (u64, u16, Vec<u8>)| {
    let (seed, place, bytes) = input;
    let mut text = shared::policy(&mut random::Random(seed)).into_bytes();
    let start = usize::from(place).min(text.len());
    let end = (start + bytes.len()).min(text.len());
    text.splice(start..end, bytes);
    answered::is_answered(&String::from_utf8_lossy(&text));
});
