//! Bytes of the scalar sensor to readings, SPI frames of the converter to conversions, bytes of NMEA 0183 to reports.

use crate::body::{Conversion, Converter};
use crate::hardware::{DataReady, SpinDelay, Stamp, System};
use crate::health::{Count, Health};
use crate::navigation::NavigationReport;
use crate::sensors::nmea::NmeaParser;
use crate::sensors::scalar::{Reading, ScalarParser, ScalarReader};
use embedded_hal::spi::SpiDevice;
use embedded_hal_nb::nb;
use embedded_hal_nb::serial::{Error, Read};
use heapless::spsc::Producer;

/// The scalar sensor's port and the queue of its readings.
pub struct ScalarInput<'a, Port, S> {
    reader: ScalarReader<Port>,
    readings: Producer<'a, Reading>,
    health: &'a Health,
    system: S,
}

impl<'a, Port: Read<u8>, S: System> ScalarInput<'a, Port, S> {
    /// A port that is set to the sensor's baud rate.
    pub fn new(
        port: Port,
        parser: ScalarParser,
        readings: Producer<'a, Reading>,
        health: &'a Health,
        system: S,
    ) -> Self {
        Self { reader: ScalarReader::new(port, parser), readings, health, system }
    }

    /// Take what has come. To be called at each byte.
    pub fn run(&mut self) {
        let now_us = self.system.stamp_us(Stamp::ScalarByte);
        while let Some(reading) = self.reader.poll(now_us) {
            self.health.counts.add_if(self.readings.enqueue(reading).is_err(), Count::ReadingsLost);
        }
        // Within a sentence nothing goes wrong that its end does not tell.
        if !self.reader.is_in_sentence() {
            self.health.counts.set_scalar(self.reader.faults());
        }
    }
}

/// The fluxgate's converter and the queue of its conversions.
pub struct FluxgateInput<'a, Bus, Ready, S> {
    data_ready: Ready,
    converter: Converter<Bus>,
    conversions: Producer<'a, Conversion>,
    health: &'a Health,
    system: S,
}

impl<'a, Bus: SpiDevice, Ready: DataReady, S: System> FluxgateInput<'a, Bus, Ready, S> {
    /// A converter that nothing has been sent to.
    pub fn new(
        bus: Bus,
        data_ready: Ready,
        conversions: Producer<'a, Conversion>,
        health: &'a Health,
        system: S,
    ) -> Self {
        Self { data_ready, converter: Converter::new(bus), conversions, health, system }
    }

    /// Fetch a conversion. To be called at each data-ready edge, and when `assemble` has missed them for a second.
    pub fn run(&mut self) {
        let Self { converter, health, system, .. } = self;
        if health.checks.converter_is_asked() {
            health.checks.set_converter(converter.identity().into());
            health.counts.set_converter(converter.faults());
        }
        let fetched = match self.data_ready.take() {
            Some(ready_us) => converter.fetch(ready_us, &mut SpinDelay(system)),
            // Nothing is ready: the converter may have no set-up.
            None => {
                converter.set_up(system.stamp_us(Stamp::SetUp), &mut SpinDelay(system));
                None
            }
        };
        match fetched {
            Some(conversion) => {
                health.tasks.conversion_came();
                health.counts.add_if(self.conversions.enqueue(conversion).is_err(), Count::ConversionsLost);
            }
            // With a conversion nothing has gone wrong.
            None => {
                health.checks.set_converter(converter.latest_set_up().into());
                health.counts.set_converter(converter.faults());
            }
        }
    }
}

/// Bytes and errors taken in one call, so that a port that never runs dry cannot hold its caller.
const LONGEST_BURST: usize = 16;

/// The third UART and the queue of what its sensors tell.
pub struct NmeaInput<'a, Port, S> {
    port: Port,
    parser: NmeaParser,
    reports: Producer<'a, NavigationReport>,
    health: &'a Health,
    system: S,
}

impl<'a, Port: Read<u8>, S: System> NmeaInput<'a, Port, S> {
    /// A port that is set to the sensors' baud rate.
    pub fn new(
        port: Port,
        parser: NmeaParser,
        reports: Producer<'a, NavigationReport>,
        health: &'a Health,
        system: S,
    ) -> Self {
        Self { port, parser, reports, health, system }
    }

    /// Take what has come. To be called at each byte.
    pub fn run(&mut self) {
        let now_us = self.system.now_us();
        for _ in 0..LONGEST_BURST {
            match self.port.read() {
                Ok(byte) => {
                    if let Some(report) = self.parser.push(byte, now_us) {
                        self.health.counts.add_if(self.reports.enqueue(report).is_err(), Count::ReadingsLost);
                    }
                }
                Err(nb::Error::Other(error)) => self.parser.receive_error(error.kind()),
                Err(nb::Error::WouldBlock) => break,
            }
        }
        self.health.counts.set_nmea(self.parser.faults());
    }
}
