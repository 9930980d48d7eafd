//! Virtual time: what is due while the storage waits for its card is done while it waits.

use super::card::SdCard;
use super::faults::Fault;
use crate::rng::Rng;
use std::cell::{Cell, RefCell};
use std::collections::VecDeque;
use std::rc::Rc;

/// Work of higher priority than the storage: called each [`TICK_NS`] of virtual time.
type Work = Box<dyn FnMut(u64)>;

/// The period of `assemble`, which runs at 25 Hz.
const TICK_NS: u64 = 40_000_000;

/// Time, the socket, and what is due.
pub struct World {
    now_ns: Cell<u64>,
    next_tick_ns: Cell<u64>,
    /// The card in the socket.
    pub socket: RefCell<Option<SdCard>>,
    /// A card on the desk, out of the socket.
    desk: RefCell<Option<SdCard>>,
    plan: RefCell<VecDeque<(u64, Fault)>>,
    work: RefCell<Option<Work>>,
    pub(super) hz: Cell<u32>,
    pub(super) is_selected: Cell<bool>,
    bits_per_error: Cell<u32>,
    pub(super) rng: RefCell<Rng>,
    /// Bytes that went over the bus.
    pub bytes: Cell<u64>,
}

impl World {
    pub fn new(card: Option<SdCard>) -> Rc<Self> {
        Rc::new(Self {
            now_ns: Cell::new(1_000_000_000),
            next_tick_ns: Cell::new(1_000_000_000 + TICK_NS),
            socket: RefCell::new(card),
            desk: RefCell::new(None),
            plan: RefCell::default(),
            work: RefCell::new(None),
            hz: Cell::new(0),
            is_selected: Cell::new(false),
            bits_per_error: Cell::new(0),
            rng: RefCell::new(Rng(7)),
            bytes: Cell::new(0),
        })
    }

    pub fn now_ns(&self) -> u64 {
        self.now_ns.get()
    }

    pub fn now_s(&self) -> f64 {
        self.now_ns() as f64 * 1e-9
    }

    /// What is done at each tick.
    pub fn set_work(&self, work: impl FnMut(u64) + 'static) {
        self.work.replace(Some(Box::new(work)));
    }

    /// This happens so many seconds from now; after what was planned before.
    pub fn plan(&self, in_s: f64, fault: Fault) {
        self.plan.borrow_mut().push_back((self.now_ns() + (in_s * 1e9) as u64, fault));
    }

    /// To the next tick.
    pub fn sleep(&self) {
        self.advance(self.next_tick_ns.get() - self.now_ns());
    }

    /// Time passes.
    pub(super) fn advance(&self, ns: u64) {
        let end_ns = self.now_ns() + ns;
        loop {
            let fault_ns = self.plan.borrow().front().map_or(u64::MAX, |(at_ns, _)| *at_ns);
            let tick_ns = self.next_tick_ns.get();
            if fault_ns.min(tick_ns) > end_ns {
                break;
            }
            self.now_ns.set(fault_ns.min(tick_ns).max(self.now_ns()));
            if fault_ns <= tick_ns {
                let fault = self.plan.borrow_mut().pop_front();
                fault.into_iter().for_each(|(_, fault)| self.happen(fault));
            } else {
                self.next_tick_ns.set(tick_ns + TICK_NS);
                if let Some(work) = self.work.borrow_mut().as_mut() {
                    work(tick_ns);
                }
            }
        }
        self.now_ns.set(end_ns);
    }

    /// Now.
    pub fn happen(&self, fault: Fault) {
        let now_ns = self.now_ns();
        let mut socket = self.socket.borrow_mut();
        match (fault, socket.as_mut()) {
            (Fault::Removed, Some(card)) => {
                card.lose_power(now_ns);
                *self.desk.borrow_mut() = socket.take();
            }
            (Fault::Inserted, None) => *socket = self.desk.borrow_mut().take(),
            (Fault::BitErrors(bits), _) => self.bits_per_error.set(bits),
            (Fault::PowerLost, Some(card)) => card.lose_power(now_ns),
            (Fault::Stalls(ms), Some(card)) => card.stall_ns = u64::from(ms) * 1_000_000,
            (Fault::ReadError, Some(card)) => card.read_fails = true,
            (Fault::WriteError, Some(card)) => card.write_fails = true,
            (Fault::ReadOnly, Some(card)) => card.is_read_only = true,
            _ => {}
        }
    }

    /// A byte on a wire that is not always good.
    pub(super) fn over_the_wire(&self, byte: u8) -> u8 {
        let bits = self.bits_per_error.get();
        if bits == 0 || self.rng.borrow_mut().below(u64::from(bits)) >= 8 {
            return byte;
        }
        byte ^ 1 << self.rng.borrow_mut().below(8)
    }
}
