//! From the interrupts of the chip to the tasks of `main.rs`, which know them by what they are for.

/// The interrupts of a board under the names that `main.rs` binds its tasks to, and what RTIC wants of a device besides.
macro_rules! name_vectors {
    ($($vector:ident as $task:ident),* $(,)?) => {
        pub mod vectors {
            pub use stm32f4xx_hal::pac::{NVIC_PRIO_BITS, Peripherals};

            pub mod interrupt {
                pub use stm32f4xx_hal::pac::Interrupt::{$($vector as $task),*};
            }
        }
    };
}

/// Run the task of this name, which RTIC has made an unmangled function of.
macro_rules! run_task {
    ($task:ident) => {{
        #[allow(unsafe_code)]
        unsafe extern "Rust" {
            fn $task();
        }
        // SAFETY: called by the one interrupt that stands for the task, at the priority that RTIC has given it.
        #[allow(unsafe_code)]
        unsafe {
            $task();
        }
    }};
}

/// Interrupts that do nothing but run their task. Wants `interrupt` of the chip's peripherals in scope.
macro_rules! hand_on {
    ($($vector:ident to $task:ident),* $(,)?) => {
        $(
            #[interrupt]
            fn $vector() {
                $crate::board::chip::vectors::run_task!($task);
            }
        )*
    };
}

pub(in crate::board) use {hand_on, name_vectors, run_task};
