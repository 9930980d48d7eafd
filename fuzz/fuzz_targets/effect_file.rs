#![no_main]
libfuzzer_sys::fuzz_target!(|data: &[u8]| towmag_fuzz::effect_file::effect_file(data));
