//! Any text as a policy: compiled, laid out, drawn, written, read again and run.
#![no_main]

#[path = "../../tests/policy_robustness/answered.rs"]
mod answered;
#[path = "../../tests/policy/machine/artifact/erratic.rs"]
mod erratic;

libfuzzer_sys::fuzz_target!(|text: &str| {
    answered::is_answered_the_same(text);
    answered::is_handled(text);
});
