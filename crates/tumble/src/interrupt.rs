//! Ctrl-C: at once, except while a result is being written; then after the clean-up.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::exit::Exit;

/// Held while a result is being written. The handler ends the process with it in its hand: nothing is begun meanwhile.
static WRITING: Mutex<()> = Mutex::new(());
static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// Takes over Ctrl-C. Where that is not possible the default (immediate end) stays.
pub(crate) fn install() {
    let _ = ctrlc::set_handler(|| {
        INTERRUPTED.store(true, Ordering::SeqCst);
        if let Ok(_nothing_is_written) = WRITING.try_lock() {
            std::process::exit(i32::from(Exit::Interrupted.code()));
        }
    });
}

/// Whether Ctrl-C was pressed.
pub(crate) fn interrupted() -> bool {
    INTERRUPTED.load(Ordering::SeqCst)
}

/// Runs what must not be cut in half.
pub(crate) fn while_writing<T>(write: impl FnOnce() -> T) -> T {
    let _writing = WRITING.lock();
    write()
}
