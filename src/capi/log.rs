//! What the library says: to the host's callback, from its own threads too, and to nobody else.

use std::ffi::{c_char, c_void};
use std::fmt::Write as _;
use std::sync::Arc;

use tracing::field::{Field, Visit};
use tracing::level_filters::LevelFilter;
use tracing::span::{Attributes, Id, Record};
use tracing::{Dispatch, Event, Level, Metadata, Subscriber};

use super::status::Fault;
use super::text;

/// Something failed, or a fault of the library's own.
pub const IRRADIA_LOG_ERROR: u32 = 1;
/// Something is not as it was asked for.
pub const IRRADIA_LOG_WARNING: u32 = 2;
/// What it does, now and then.
pub const IRRADIA_LOG_INFO: u32 = 3;
/// What it does, in detail.
pub const IRRADIA_LOG_DEBUG: u32 = 4;

/// Hears what the library says: one message, UTF-8, which stands during the call. It may be called from any thread, the library's own included, and from
/// several at once. It must not call the library.
pub type LogFunction = Option<unsafe extern "C" fn(user: *mut c_void, level: u32, message: *const c_char)>;

struct HostLog {
    function: unsafe extern "C" fn(*mut c_void, u32, *const c_char),
    user: *mut c_void,
    most: Level,
}

// SAFETY: the header says that the function is called from any thread, and the pointer with it.
unsafe impl Send for HostLog {}
// SAFETY: as above.
unsafe impl Sync for HostLog {}

/// Where a context's messages go. `level` 0: warnings and worse.
pub(super) fn dispatch(function: LogFunction, user: *mut c_void, level: u32) -> Result<Dispatch, Fault> {
    let most = match level {
        IRRADIA_LOG_ERROR => Level::ERROR,
        0 | IRRADIA_LOG_WARNING => Level::WARN,
        IRRADIA_LOG_INFO => Level::INFO,
        IRRADIA_LOG_DEBUG => Level::DEBUG,
        _ => return Err(Fault::argument(format!("the log level is {level}; write one of IRRADIA_LOG_…"))),
    };
    let log = function.map(|function| Dispatch::from(Arc::new(HostLog { function, user, most }) as Arc<_>));
    Ok(log.unwrap_or_else(Dispatch::none))
}

impl Subscriber for HostLog {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        metadata.is_event() && *metadata.level() <= self.most && metadata.target().starts_with("irradia")
    }

    fn max_level_hint(&self) -> Option<LevelFilter> {
        Some(LevelFilter::from_level(self.most))
    }

    fn new_span(&self, _: &Attributes<'_>) -> Id {
        Id::from_u64(1)
    }

    fn record(&self, _: &Id, _: &Record<'_>) {}

    fn record_follows_from(&self, _: &Id, _: &Id) {}

    fn event(&self, event: &Event<'_>) {
        let mut message = Message::default();
        event.record(&mut message);
        let level = match *event.metadata().level() {
            Level::ERROR => IRRADIA_LOG_ERROR,
            Level::WARN => IRRADIA_LOG_WARNING,
            Level::INFO => IRRADIA_LOG_INFO,
            _ => IRRADIA_LOG_DEBUG,
        };
        let message = text::owned(&message.0);
        // SAFETY: the host's function with the host's pointer.
        unsafe { (self.function)(self.user, level, message.as_ptr()) };
    }

    fn enter(&self, _: &Id) {}

    fn exit(&self, _: &Id) {}
}

#[derive(Default)]
struct Message(String);

impl Visit for Message {
    fn record_debug(&mut self, field: &Field, value: &dyn std::fmt::Debug) {
        let gap = if self.0.is_empty() { "" } else { "; " };
        // Writing to a string does not fail.
        let _ = match field.name() {
            "message" => write!(self.0, "{gap}{value:?}"),
            name => write!(self.0, "{gap}{name}: {value:?}"),
        };
    }
}
