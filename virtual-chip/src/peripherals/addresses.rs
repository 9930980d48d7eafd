//! Names of the addresses, for complaints.

use super::complaint::Complaint;

/// Number of a port of pins: 0 is A.
pub(super) fn port(address: u32) -> usize {
    (address as usize & 0xFFFF) / 0x400
}

/// The program does this with a register that nothing here knows.
pub(super) fn unknown(does: &str, address: u32) -> Complaint {
    Complaint(format!("{does} {address:#010x} ({}), which nothing here models", name(address)))
}

/// Name and offset of a register.
pub(super) fn name(address: u32) -> String {
    let block = match address & !0x3FF {
        0x4000_0000 => "TIM2",
        0x4000_0800 => "TIM4",
        0x4000_0C00 => "TIM5",
        0x4000_3000 => "IWDG",
        0x4000_3800 => "SPI2",
        0x4000_4400 => "USART2",
        0x4000_4800 => "USART3",
        0x4000_7000 => "PWR",
        0x4001_1000 => "USART1",
        0x4001_2000 => "ADC",
        0x4001_3000 => "SPI1",
        0x4001_3800 => "SYSCFG",
        0x4001_3C00 => "EXTI",
        0x4002_0000 => "GPIOA",
        0x4002_0400 => "GPIOB",
        0x4002_0800 => "GPIOC",
        0x4002_3800 => "RCC",
        0x4002_3C00 => "FLASH",
        0xE000_0000.. => "core",
        _ => "unknown",
    };
    format!("{block}+{:#x}", address & 0x3FF)
}
