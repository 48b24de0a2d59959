//! A sensor.

use crate::address::Address;
use crate::checked_settings::CheckedSettings;
use crate::command::{CommandError, EXIT, READ_MEASUREMENT, READ_REGISTER, RESET, START_BURST, Step, WRITE_REGISTER};
use crate::measurement::{Measurement, decode};
use crate::raw_read::RawRead;
use crate::read_error::ReadError;
use crate::register::Register;
use crate::start::{StartError, StartReport};
use crate::status::Status;
use crate::timing::{EXIT_MS, RESET_MS};
use crate::wrap_watch::WrapWatch;
use embedded_hal::delay::DelayNs;
use embedded_hal::i2c::I2c;

/// A sensor at an address. It does not own the bus, so several sensors can share one.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Sensor {
    address: Address,
    settings: CheckedSettings,
    /// The counts of X, Y and Z since the start.
    watches: [WrapWatch; 3],
}

impl Sensor {
    /// Creates a sensor without any communication. [`Sensor::start`] configures it.
    #[must_use]
    pub const fn new(address: Address, settings: CheckedSettings) -> Self {
        Self { address, settings, watches: [WrapWatch::new(); 3] }
    }

    /// The address.
    #[must_use]
    pub const fn address(&self) -> Address {
        self.address
    }

    /// The settings.
    #[must_use]
    pub const fn settings(&self) -> &CheckedSettings {
        &self.settings
    }

    /// Resets and configures the sensor, and starts burst mode.
    ///
    /// Each written register is read back. The bits of the factory trim in register 0 are kept. It takes 3 ms and 10
    /// transactions. Until the first conversion ends, [`Sensor::read`] returns [`ReadError::Stale`].
    ///
    /// # Errors
    /// A [`StartError`] with the step that failed. A start can be repeated at any time. For 1.5 ms after its supply returns, a
    /// sensor does not answer.
    pub fn start<I: I2c>(
        &mut self,
        bus: &mut I,
        delay: &mut impl DelayNs,
    ) -> Result<StartReport, StartError<I::Error>> {
        self.watches = [WrapWatch::new(); 3];
        // The sensor may be in any mode, so this status says nothing.
        self.command(bus, Step::Exit, &[EXIT])?;
        delay.delay_ms(EXIT_MS);
        bus.write(self.address.get(), &[RESET]).map_err(|error| CommandError::Bus { step: Step::Reset, error })?;
        delay.delay_ms(RESET_MS);

        // The first status after a reset reports it. Any command reads it.
        let (reset_status, current_gain) = self.read_register(bus, Register::GAIN)?;
        if reset_status.is_impossible() || !reset_status.reset() {
            return Err(StartError::NoReset { status: reset_status });
        }
        let mut corrected_bit = reset_status.corrected_bit();
        let values = self.settings.register_values(current_gain);
        for (register, value) in values {
            corrected_bit |= self.write_register(bus, register, value)?.corrected_bit();
        }
        for (register, written) in values {
            let (_, read) = self.read_register(bus, register)?;
            if read != written {
                return Err(StartError::ReadBack { register, written, read });
            }
        }
        let start = START_BURST | self.settings.get().axes.nibble();
        let burst_status = self.command(bus, Step::StartBurst, &[start])?;
        if burst_status.is_impossible() || burst_status.error() || !burst_status.burst_mode() {
            return Err(StartError::BurstRefused { status: burst_status });
        }
        let [(_, gain), (_, conversion), (_, mode)] = values;
        let [high, _] = gain.to_be_bytes();
        Ok(StartReport {
            registers: [gain, mode, conversion],
            factory_trim: high >> 1,
            corrected_bit: corrected_bit | burst_status.corrected_bit(),
            burst_status,
        })
    }

    /// Reads the last measurement in one transaction.
    ///
    /// # Errors
    /// A [`ReadError`]. Its table in the documentation of the crate tells the reaction.
    pub fn read<I: I2c>(&mut self, bus: &mut I) -> Result<Measurement, ReadError<I::Error>> {
        let axes = self.settings.get().axes;
        let mut raw = RawRead { bytes: [0; 9], length: axes.answer_length() };
        let answer = raw.bytes.get_mut(..usize::from(raw.length)).unwrap_or_default();
        bus.write_read(self.address.get(), &[READ_MEASUREMENT | axes.nibble()], answer).map_err(ReadError::Bus)?;
        let decoded = decode(&self.settings, raw.as_bytes()).map_err(ReadError::on_bus)?;
        Ok(decoded.watch(&mut self.watches))
    }

    /// Ends burst mode. Registers can be read and written then.
    ///
    /// # Errors
    /// A [`CommandError`], also if the sensor is still in burst mode.
    pub fn stop<I: I2c>(&mut self, bus: &mut I) -> Result<Status, CommandError<I::Error>> {
        let status = self.command(bus, Step::Exit, &[EXIT])?;
        accepted(Step::Exit, status, !status.burst_mode())
    }

    /// Reads a register, outside burst mode. The result is the status and the value.
    ///
    /// # Errors
    /// A [`CommandError`].
    pub fn read_register<I: I2c>(
        &mut self,
        bus: &mut I,
        register: Register,
    ) -> Result<(Status, u16), CommandError<I::Error>> {
        let step = Step::ReadRegister(register);
        let mut answer = [0; 3];
        bus.write_read(self.address.get(), &[READ_REGISTER, register.get() << 2], &mut answer)
            .map_err(|error| CommandError::Bus { step, error })?;
        let [status, high, low] = answer;
        let status = accepted(step, Status::from_byte(status), true)?;
        Ok((status, u16::from_be_bytes([high, low])))
    }

    /// Writes a register in volatile memory, outside burst mode.
    ///
    /// Bits 15 to 9 of register 0 are calibrated in the factory. Read the register first, and keep them.
    ///
    /// # Errors
    /// A [`CommandError`].
    pub fn write_register<I: I2c>(
        &mut self,
        bus: &mut I,
        register: Register,
        value: u16,
    ) -> Result<Status, CommandError<I::Error>> {
        let step = Step::WriteRegister(register);
        let [high, low] = value.to_be_bytes();
        let status = self.command(bus, step, &[WRITE_REGISTER, high, low, register.get() << 2])?;
        accepted(step, status, true)
    }

    /// Sends a command and returns its status.
    fn command<I: I2c>(&self, bus: &mut I, step: Step, bytes: &[u8]) -> Result<Status, CommandError<I::Error>> {
        let mut status = [0];
        bus.write_read(self.address.get(), bytes, &mut status).map_err(|error| CommandError::Bus { step, error })?;
        let [status] = status;
        Ok(Status::from_byte(status))
    }
}

/// The status if it reports no error and the condition holds.
fn accepted<E>(step: Step, status: Status, condition: bool) -> Result<Status, CommandError<E>> {
    if status.error() || !condition { Err(CommandError::Rejected { step, status }) } else { Ok(status) }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    extern crate std;
    use super::*;
    use crate::{Axes, Settings};
    use embedded_hal::i2c::{ErrorKind, NoAcknowledgeSource};
    use embedded_hal_mock::eh1::delay::{CheckedDelay, NoopDelay, Transaction as Delay};
    use embedded_hal_mock::eh1::i2c::{Mock, Transaction};
    use std::string::ToString;
    use std::vec;
    use std::vec::Vec;

    const ADDRESS: u8 = 0x0C;

    fn sensor() -> Sensor {
        Sensor::new(Address::new(ADDRESS).unwrap(), Settings::array().check().unwrap())
    }

    fn exchange(written: &[u8], answer: &[u8]) -> Transaction {
        Transaction::write_read(ADDRESS, written.to_vec(), answer.to_vec())
    }

    /// The transactions of a start that succeeds, with the factory trim 0x2D.
    fn start() -> Vec<Transaction> {
        vec![
            exchange(&[0x80], &[0x00]),
            Transaction::write(ADDRESS, vec![0xF0]),
            exchange(&[0x50, 0x00], &[0x04, 0x5A, 0x0C]),
            exchange(&[0x60, 0x5A, 0x7C, 0x00], &[0x00]),
            exchange(&[0x60, 0x00, 0x0E, 0x08], &[0x00]),
            exchange(&[0x60, 0x01, 0x00, 0x04], &[0x00]),
            exchange(&[0x50, 0x00], &[0x00, 0x5A, 0x7C]),
            exchange(&[0x50, 0x08], &[0x00, 0x00, 0x0E]),
            exchange(&[0x50, 0x04], &[0x00, 0x01, 0x00]),
            exchange(&[0x14], &[0x80]),
        ]
    }

    /// The result of a start with transaction `index` replaced and all later ones omitted.
    fn start_until(index: usize, last: Transaction) -> Result<StartReport, StartError<ErrorKind>> {
        let mut expected = start();
        expected.truncate(index);
        expected.push(last);
        let mut bus = Mock::new(&expected);
        let result = sensor().start(&mut bus, &mut NoopDelay::new());
        bus.done();
        result
    }

    #[test]
    fn a_start_has_exactly_the_transactions_and_pauses_of_the_data_sheet() {
        let mut bus = Mock::new(&start());
        let mut delay = CheckedDelay::new(&[Delay::delay_ms(1), Delay::delay_ms(2)]);
        let report = sensor().start(&mut bus, &mut delay).unwrap();
        assert_eq!(report.registers, [0x5A7C, 0x0100, 0x000E]);
        assert_eq!((report.factory_trim, report.corrected_bit), (0x2D, false));
        bus.done();
        delay.done();
    }

    #[test]
    fn a_start_reports_a_corrected_bit() {
        let mut expected = start();
        expected[4] = exchange(&[0x60, 0x00, 0x0E, 0x08], &[0x08]);
        let mut bus = Mock::new(&expected);
        assert!(sensor().start(&mut bus, &mut NoopDelay::new()).unwrap().corrected_bit);
        bus.done();
    }

    #[test]
    fn an_absent_sensor_is_an_error_at_the_first_step() {
        let absent = ErrorKind::NoAcknowledge(NoAcknowledgeSource::Address);
        let error = start_until(0, exchange(&[0x80], &[0]).with_error(absent)).unwrap_err();
        assert_eq!(error, StartError::Command(CommandError::Bus { step: Step::Exit, error: absent }));
        assert!(error.to_string().starts_with("at ending the current mode, the bus reports NoAcknowledge(Address)."));
    }

    #[test]
    fn a_device_that_does_not_report_the_reset_is_refused() {
        for status in [0x00, 0xEF] {
            let error = start_until(2, exchange(&[0x50, 0x00], &[status, 0x5A, 0x0C])).unwrap_err();
            assert_eq!(error, StartError::NoReset { status: Status::from_byte(status) });
        }
    }

    #[test]
    fn each_register_is_compared_with_what_was_written() {
        for (index, register, written) in
            [(6, Register::GAIN, 0x5A7C), (7, Register::CONVERSION, 0x000E), (8, Register::MODE, 0x0100)]
        {
            let read = written ^ 0x0004;
            let [high, low] = u16::to_be_bytes(read);
            let error = start_until(index, exchange(&[0x50, register.get() << 2], &[0, high, low])).unwrap_err();
            assert_eq!(error, StartError::ReadBack { register, written, read });
        }
    }

    #[test]
    fn a_rejected_write_names_its_register() {
        let error = start_until(4, exchange(&[0x60, 0x00, 0x0E, 0x08], &[0x10])).unwrap_err();
        let step = Step::WriteRegister(Register::CONVERSION);
        assert_eq!(error, StartError::Command(CommandError::Rejected { step, status: Status::from_byte(0x10) }));
    }

    #[test]
    fn burst_mode_without_its_status_bit_is_an_error() {
        for status in [0x00, 0x90, 0x10] {
            let error = start_until(9, exchange(&[0x14], &[status])).unwrap_err();
            assert_eq!(error, StartError::BurstRefused { status: Status::from_byte(status) });
        }
    }

    #[test]
    fn a_read_is_one_transaction_of_the_selected_quantities() {
        for nibble in 1..16_u8 {
            let axes = Axes::from_nibble(nibble);
            let settings = Settings { axes, ..Settings::array() }.check().unwrap();
            let mut answer = vec![0x80 | (axes.count() - 1)];
            answer.resize(usize::from(axes.answer_length()), 7);
            let mut bus = Mock::new(&[exchange(&[0x40 | nibble], &answer)]);
            let measurement = Sensor::new(Address::new(ADDRESS).unwrap(), settings).read(&mut bus).unwrap();
            assert_eq!(measurement.raw.as_bytes(), answer);
            bus.done();
        }
    }

    #[test]
    fn an_error_of_the_bus_is_passed_on() {
        let mut bus = Mock::new(&[exchange(&[0x44], &[0, 0, 0]).with_error(ErrorKind::ArbitrationLoss)]);
        assert_eq!(sensor().read(&mut bus), Err(ReadError::Bus(ErrorKind::ArbitrationLoss)));
        bus.done();
    }

    #[test]
    fn a_stop_that_leaves_burst_mode_on_is_an_error() {
        let mut bus = Mock::new(&[exchange(&[0x80], &[0x00]), exchange(&[0x80], &[0x80])]);
        assert_eq!(sensor().stop(&mut bus), Ok(Status::from_byte(0)));
        assert!(matches!(sensor().stop(&mut bus), Err(CommandError::Rejected { step: Step::Exit, .. })));
        bus.done();
    }
}
