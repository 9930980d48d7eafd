#![no_main]
libfuzzer_sys::fuzz_target!(|data: &[u8]| towmag_fuzz::importer::import_formats(data));
