//! The functions that the page calls. A text is bytes of UTF-8 in the memory of the module, at an address and with a length.
#![expect(unsafe_code, reason = "an export has its own name; nothing else here is unsafe")]

use std::cell::RefCell;

use crate::Playground;

/// The playground with the buffers of its texts. The module has one thread.
#[derive(Default)]
struct Held {
    playground: Playground,
    request: Vec<u8>,
    answer: String,
}

thread_local! {
    static HELD: RefCell<Held> = RefCell::default();
}

/// Reserves memory for a request. The result is its address, to which the page writes as many bytes.
#[unsafe(no_mangle)]
extern "C" fn reserve(length: usize) -> usize {
    HELD.with_borrow_mut(|held| {
        held.request.clear();
        held.request.resize(length, 0);
        held.request.as_mut_ptr() as usize
    })
}

/// Answers the request. The result is the length of the answer.
#[unsafe(no_mangle)]
extern "C" fn answer() -> usize {
    HELD.with_borrow_mut(|held| {
        let Held { playground, request, answer } = held;
        *answer = playground.answer(&String::from_utf8_lossy(request));
        answer.len()
    })
}

/// The address of the answer.
#[unsafe(no_mangle)]
extern "C" fn answered() -> usize {
    HELD.with_borrow(|held| held.answer.as_ptr() as usize)
}
