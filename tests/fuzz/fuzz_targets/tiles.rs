//! `tiles` for libFuzzer.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| cosfly_fuzz::target("tiles")(bytes));
