//! The body's tasks, its log and its card on a board in memory, as one program.

mod card_away;
mod fluxgate_calibration;
mod logbook;
mod power_cut;
mod sd_model;
mod task_clock;
mod task_console;
mod task_fluxgate_calibration;
mod task_housekeeping;
mod task_navigation;
mod task_self_test;
mod task_storage;
mod task_telemetry;
mod voyages;
