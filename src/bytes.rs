//! Little-endian numbers into and out of byte slices, without a panic on any input.

/// Fills a slice from the front and remembers when it was too short.
pub(crate) struct Put<'a> {
    out: &'a mut [u8],
    len: usize,
    fits: bool,
}

impl<'a> Put<'a> {
    pub(crate) fn new(out: &'a mut [u8]) -> Self {
        Self { out, len: 0, fits: true }
    }

    pub(crate) fn bytes(&mut self, bytes: &[u8]) {
        match self.out.get_mut(self.len..).and_then(|rest| rest.get_mut(..bytes.len())) {
            Some(place) => {
                place.copy_from_slice(bytes);
                self.len += bytes.len();
            }
            None => self.fits = false,
        }
    }

    pub(crate) fn u8(&mut self, value: u8) {
        self.bytes(&[value]);
    }

    pub(crate) fn u16(&mut self, value: u16) {
        self.bytes(&value.to_le_bytes());
    }

    pub(crate) fn u32(&mut self, value: u32) {
        self.bytes(&value.to_le_bytes());
    }

    pub(crate) fn i32(&mut self, value: i32) {
        self.bytes(&value.to_le_bytes());
    }

    pub(crate) fn u64(&mut self, value: u64) {
        self.bytes(&value.to_le_bytes());
    }

    pub(crate) fn f32(&mut self, value: f32) {
        self.u32(value.to_bits());
    }

    pub(crate) fn f64(&mut self, value: f64) {
        self.u64(value.to_bits());
    }

    /// A length in one byte, then the bytes.
    pub(crate) fn text(&mut self, text: &str) {
        match u8::try_from(text.len()) {
            Ok(len) => {
                self.u8(len);
                self.bytes(text.as_bytes());
            }
            Err(_) => self.fits = false,
        }
    }

    /// For a value that the format has no room for.
    pub(crate) fn refuse(&mut self) {
        self.fits = false;
    }

    /// Bytes written; `None` when something did not fit.
    pub(crate) fn finish(self) -> Option<usize> {
        self.fits.then_some(self.len)
    }
}

/// Takes values off the front of a slice; `None` from the first that is not all there.
pub(crate) struct Take<'a>(pub(crate) &'a [u8]);

impl<'a> Take<'a> {
    pub(crate) fn bytes(&mut self, len: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.0.split_at_checked(len)?;
        self.0 = rest;
        Some(taken)
    }

    pub(crate) fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (taken, rest) = self.0.split_first_chunk::<N>()?;
        self.0 = rest;
        Some(*taken)
    }

    pub(crate) fn u8(&mut self) -> Option<u8> {
        self.array().map(u8::from_le_bytes)
    }

    pub(crate) fn u16(&mut self) -> Option<u16> {
        self.array().map(u16::from_le_bytes)
    }

    pub(crate) fn u32(&mut self) -> Option<u32> {
        self.array().map(u32::from_le_bytes)
    }

    pub(crate) fn i32(&mut self) -> Option<i32> {
        self.array().map(i32::from_le_bytes)
    }

    pub(crate) fn u64(&mut self) -> Option<u64> {
        self.array().map(u64::from_le_bytes)
    }

    pub(crate) fn f32(&mut self) -> Option<f32> {
        self.u32().map(f32::from_bits)
    }

    pub(crate) fn f64(&mut self) -> Option<f64> {
        self.u64().map(f64::from_bits)
    }

    /// What [`Put::text`] wrote; `None` also when it is not UTF-8 or longer than `N`.
    pub(crate) fn text<const N: usize>(&mut self) -> Option<heapless::String<N>> {
        let len = self.u8()?;
        let text = core::str::from_utf8(self.bytes(usize::from(len))?).ok()?;
        heapless::String::try_from(text).ok()
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

/// Write a value that may be missing; that it is there is noted elsewhere.
pub(crate) fn put_some<T>(value: Option<T>, put: impl FnOnce(T)) {
    if let Some(value) = value {
        put(value);
    }
}

/// Take a value that may be missing: `None` when it should be there and is not.
pub(crate) fn take_some<T>(is_there: bool, take: impl FnOnce() -> Option<T>) -> Option<Option<T>> {
    if is_there { take().map(Some) } else { Some(None) }
}
