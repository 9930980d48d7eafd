//! ADS131M04: frames with their CRC, set-up with read-back, and every fault, over a mocked SPI device.

use embedded_hal::spi::{ErrorKind, Operation, SpiDevice};
use embedded_hal_mock::eh1::delay::NoopDelay;
use embedded_hal_mock::eh1::spi::{Mock, Transaction};
use proptest::prelude::*;
use towmag::sensors::ads131m04::{
    AdcError, AdcFrame, AdcSettings, Ads131m04, Command, FRAME_BYTES, Gain, Oversampling, Register, StatusWord, encode,
};

/// The CRC again, bit by bit, as an oracle for the one of the crate.
fn crc(bytes: &[u8]) -> u16 {
    bytes.iter().fold(0xFFFF, |crc, byte| {
        (0..8).fold(crc ^ u16::from(*byte) << 8, |crc, _| if crc & 0x8000 != 0 { crc << 1 ^ 0x1021 } else { crc << 1 })
    })
}

/// What the converter sends.
fn answer(response: u16, counts: [i32; 4]) -> [u8; FRAME_BYTES] {
    let mut bytes = [0; FRAME_BYTES];
    bytes[..2].copy_from_slice(&response.to_be_bytes());
    for (count, word) in counts.iter().zip(bytes[3..15].chunks_mut(3)) {
        word.copy_from_slice(&count.to_be_bytes()[1..]);
    }
    let crc = crc(&bytes[..15]);
    bytes[15..17].copy_from_slice(&crc.to_be_bytes());
    bytes
}

fn frame(command: Command, answer: [u8; FRAME_BYTES]) -> [Transaction<u8>; 3] {
    [
        Transaction::transaction_start(),
        Transaction::transfer_in_place(encode(command).to_vec(), answer.to_vec()),
        Transaction::transaction_end(),
    ]
}

/// A whole set-up that goes well.
fn good_set_up() -> Vec<(Command, u16)> {
    let mut script = vec![
        (Command::Unlock, 0x0500),
        (Command::Reset, 0x0655),
        (Command::Read(Register::Id), 0xFF24),
        (Command::Null, 0x2403),
    ];
    let mut before = 0x050F;
    for (register, value, acknowledgement) in [
        (Register::Mode, 0x1110, 0x4100),
        (Register::Clock, 0x0F1E, 0x4180),
        (Register::Gain, 0x0000, 0x4200),
        (Register::Configuration, 0x0600, 0x4300),
    ] {
        script.push((Command::Write(register, value), before));
        script.push((Command::Read(register), acknowledgement));
        script.push((Command::Null, value));
        before = 0x010F;
    }
    script.extend([(Command::Null, 0x010F), (Command::Null, 0x010F)]);
    script
}

fn mock(script: &[(Command, u16)]) -> Mock<u8> {
    let frames: Vec<_> =
        script.iter().flat_map(|(command, response)| frame(*command, answer(*response, [0; 4]))).collect();
    Mock::new(&frames)
}

fn set_up(script: &[(Command, u16)]) -> (Result<u16, AdcError>, u32) {
    let mut adc = Ads131m04::new(mock(script), AdcSettings::default());
    let result = adc.init(&mut NoopDelay::new());
    let faults = adc.faults().set_up;
    adc.release().done();
    (result, faults)
}

/// One read with this answer.
fn read(answer: [u8; FRAME_BYTES]) -> (Result<[i32; 4], AdcError>, Ads131m04<Mock<u8>>) {
    let mut adc = Ads131m04::new(Mock::new(&frame(Command::Null, answer)), AdcSettings::default());
    let result = adc.read();
    (result, adc)
}

#[test]
fn commands_have_the_known_crcs() {
    assert_eq!(crc(b"123456789"), 0x29B1);
    for (command, bytes) in [
        (Command::Null, [0x00, 0x00, 0, 0xCC, 0x9C, 0, 0, 0, 0]),
        (Command::Read(Register::Id), [0xA0, 0x00, 0, 0x71, 0x00, 0, 0, 0, 0]),
        (Command::Read(Register::Status), [0xA0, 0x80, 0, 0x6A, 0x98, 0, 0, 0, 0]),
        (Command::Reset, [0x00, 0x11, 0, 0xFC, 0xDE, 0, 0, 0, 0]),
        (Command::Write(Register::Clock, 0x0F1E), [0x61, 0x80, 0, 0x0F, 0x1E, 0, 0x3A, 0x35, 0]),
    ] {
        assert_eq!(encode(command)[..9], bytes, "{command:?}");
        assert_eq!(encode(command)[9..], [0; 9], "{command:?}");
    }
    assert_eq!(Command::Write(Register::Clock, 0x0F1E).acknowledgement(), 0x4180);
}

#[test]
fn frames_are_taken_apart() {
    let bytes =
        [0x05, 0x0F, 0x00, 0x01, 0x23, 0x45, 0xFF, 0xFF, 0xFF, 0x80, 0x00, 0x00, 0x7F, 0xFF, 0xFF, 0x01, 0x6A, 0x00];
    let frame = AdcFrame::decode(&bytes).unwrap();
    assert_eq!(frame, AdcFrame { response: 0x050F, counts: [0x012345, -1, -8_388_608, 8_388_607] });
    let status = StatusWord(frame.response);
    assert!(status.was_reset() && status.word_length_is_24() && status.all_ready() && !status.is_locked());
}

#[test]
fn a_frame_of_a_real_chip() {
    // From a user's report to the maker (E2E forum, thread 1011774): a locked chip without input.
    let mut bytes = [0; FRAME_BYTES];
    bytes[0] = 0x81;
    [bytes[15], bytes[16]] = [0xB4, 0x2D];
    let frame = AdcFrame::decode(&bytes).unwrap();
    assert_eq!(frame, AdcFrame { response: 0x8100, counts: [0; 4] });
    assert!(StatusWord(frame.response).is_locked() && !StatusWord(frame.response).all_ready());
}

#[test]
fn set_up_writes_and_reads_back() {
    assert_eq!(set_up(&good_set_up()), (Ok(0x2403), 0));
}

#[test]
fn settings_make_the_registers() {
    let settings = AdcSettings {
        gains: [Gain::X1, Gain::X2, Gain::X128, Gain::X16],
        oversampling: Oversampling::X1024,
        global_chop: true,
    };
    let expected = [
        (Register::Mode, 0x1110),
        (Register::Clock, 0x0F0E), // the chip's own default
        (Register::Gain, 0x4710),
        (Register::Configuration, 0x0700),
    ];
    assert_eq!(settings.registers(), expected);
}

#[test]
fn set_up_finds_every_wrong_answer() {
    let good = good_set_up();
    let with = |at: usize, response: u16| {
        let mut script = good[..=at].to_vec();
        script[at].1 = response;
        set_up(&script)
    };
    // Nothing there: the line floats high or low, and the CRC does not fit all ones.
    assert_eq!(with(2, 0x0011), (Err(AdcError::NoReset { response: 0x0011 }), 1));
    assert_eq!(with(2, 0xFF23), (Err(AdcError::NoReset { response: 0xFF23 }), 1));
    assert_eq!(with(3, 0x2303), (Err(AdcError::WrongId { id: 0x2303 }), 1));
    let register = Register::Mode;
    assert_eq!(with(5, 0x6100), (Err(AdcError::NotAcknowledged { register, response: 0x6100 }), 1));
    let register = Register::Clock;
    let mismatch = AdcError::RegisterMismatch { register, written: 0x0F1E, read: 0x0F0E };
    assert_eq!(with(9, 0x0F0E), (Err(mismatch), 1));
}

#[test]
fn the_identity_is_asked_between_two_conversions() {
    let ask = |id: u16| {
        let mut adc =
            Ads131m04::new(mock(&[(Command::Read(Register::Id), 0x050F), (Command::Null, id)]), AdcSettings::default());
        let identity = adc.identity();
        adc.release().done();
        identity
    };
    assert_eq!(ask(0x2403), Ok(0x2403));
    assert_eq!(ask(0x2203), Err(AdcError::WrongId { id: 0x2203 }));
}

#[test]
fn a_silent_bus_is_no_converter() {
    for silence in [0x00, 0xFF] {
        let frames: Vec<_> = [Command::Unlock, Command::Reset, Command::Read(Register::Id)]
            .into_iter()
            .flat_map(|command| frame(command, [silence; FRAME_BYTES]))
            .collect();
        let mut adc = Ads131m04::new(Mock::new(&frames), AdcSettings::default());
        assert!(matches!(adc.init(&mut NoopDelay::new()), Err(AdcError::Crc(_))));
        assert_eq!((adc.faults().crc, adc.faults().set_up), (1, 0));
        adc.release().done();
    }
}

#[test]
fn reads_and_status_flags() {
    let counts = [1, -2, 8_388_607, -8_388_608];
    let expect = |status: u16, expected: Result<[i32; 4], AdcError>| {
        let (result, adc) = read(answer(status, counts));
        assert_eq!(result, expected, "{status:04X}");
        let faults = *adc.faults();
        let all = faults.spi
            + faults.crc
            + faults.set_up
            + faults.resets
            + faults.resynchronisations
            + faults.command_crc
            + faults.corrupted
            + faults.stale;
        assert_eq!(all, u32::from(expected.is_err()));
        adc.release().done();
    };
    expect(0x010F, Ok(counts));
    expect(0x810F, Ok(counts)); // locked does not matter here
    expect(0x050F, Err(AdcError::Reset(StatusWord(0x050F))));
    expect(0x410F, Err(AdcError::Resynchronised(StatusWord(0x410F))));
    expect(0x110F, Err(AdcError::CommandCrc(StatusWord(0x110F))));
    expect(0x210F, Err(AdcError::Corrupted(StatusWord(0x210F))));
    expect(0x090F, Err(AdcError::Corrupted(StatusWord(0x090F))));
    expect(0x000F, Err(AdcError::Corrupted(StatusWord(0x000F))));
    expect(0x0107, Err(AdcError::Stale(StatusWord(0x0107))));
}

#[test]
fn faults_of_the_bus_keep_their_kind() {
    struct Broken;
    impl embedded_hal::spi::ErrorType for Broken {
        type Error = ErrorKind;
    }
    impl SpiDevice for Broken {
        fn transaction(&mut self, _: &mut [Operation<'_, u8>]) -> Result<(), ErrorKind> {
            Err(ErrorKind::ModeFault)
        }
    }
    let mut adc = Ads131m04::new(Broken, AdcSettings::default());
    assert_eq!(adc.read(), Err(AdcError::Spi(ErrorKind::ModeFault)));
    assert_eq!(adc.init(&mut NoopDelay::new()), Err(AdcError::Spi(ErrorKind::ModeFault)));
    assert_eq!(adc.faults().spi, 2);
}

/// A CRC of 16 bits finds every error of one or two bits in a frame this short.
#[test]
fn flipped_bits_are_found() {
    let good = answer(0x010F, [1, -2, 0x0123_4567 >> 4, -8_388_608]);
    for (first, second) in (0..136).flat_map(|first| (first..136).map(move |second| (first, second))) {
        let mut bytes = good;
        bytes[first / 8] ^= 1 << (first % 8);
        if second != first {
            bytes[second / 8] ^= 1 << (second % 8);
        }
        assert!(AdcFrame::decode(&bytes).is_err(), "{first} {second}");
    }
    let mut bytes = good;
    bytes[5] ^= 1;
    let (result, adc) = read(bytes);
    assert!(matches!(result, Err(AdcError::Crc(_))));
    assert_eq!(adc.faults().crc, 1);
    adc.release().done();
}

proptest! {
    #[test]
    fn frames_round_trip(response in any::<u16>(), counts in proptest::array::uniform4(-8_388_608..=8_388_607_i32)) {
        prop_assert_eq!(AdcFrame::decode(&answer(response, counts)), Ok(AdcFrame { response, counts }));
    }

    #[test]
    fn any_frame_does_no_harm(bytes in proptest::array::uniform18(any::<u8>())) {
        let (result, adc) = read(bytes);
        prop_assert!(result.is_err() || crc(&bytes[..15]).to_be_bytes() == bytes[15..17]);
        adc.release().done();
    }
}
