//! The threads that a context works with: its own, so that they say what they say to its log, and end with it.

use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;

use rayon::{ThreadPool, ThreadPoolBuilder};
use tracing::Dispatch;

use super::border::stay_inside;
use super::status::{Fault, IRRADIA_ERROR_INTERNAL};

/// A pool, and where it says what happens.
pub(super) struct Workers {
    pool: Option<ThreadPool>,
    threads: Arc<Mutex<Vec<JoinHandle<()>>>>,
    log: Dispatch,
}

impl Workers {
    pub(super) fn new(log: Dispatch) -> Result<Workers, Fault> {
        let threads = Arc::new(Mutex::new(Vec::new()));
        let (heard, started) = (log.clone(), threads.clone());
        let pool = ThreadPoolBuilder::new().spawn_handler(move |thread| {
            let log = heard.clone();
            let name = format!("irradia-{}", thread.index());
            let run = move || {
                stay_inside();
                tracing::dispatcher::with_default(&log, || thread.run());
            };
            let handle = std::thread::Builder::new().name(name).spawn(run)?;
            started.lock().unwrap_or_else(PoisonError::into_inner).push(handle);
            Ok(())
        });
        let pool = pool.build().map_err(|error| Fault {
            status: IRRADIA_ERROR_INTERNAL,
            sentence: format!("the library's threads cannot be started: {error}"),
        })?;
        Ok(Workers { pool: Some(pool), threads, log })
    }

    /// Runs work that may be shared between these threads.
    pub(super) fn run<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        match &self.pool {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }

    /// Runs work of the calling thread's own.
    pub(super) fn listen<R>(&self, work: impl FnOnce() -> R) -> R {
        tracing::dispatcher::with_default(&self.log, work)
    }
}

impl Drop for Workers {
    fn drop(&mut self) {
        // The threads end once the pool is gone.
        self.pool = None;
        let threads = std::mem::take(&mut *self.threads.lock().unwrap_or_else(PoisonError::into_inner));
        for thread in threads {
            // What a thread threw was told by the call that it worked for.
            let _ = thread.join();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::border::call;
    use super::*;

    #[test]
    fn a_panic_of_a_worker_is_a_status_too() {
        let status = call(|_| {
            let workers = Workers::new(Dispatch::none())?;
            workers.run(|| panic!("far away"));
            Ok(())
        });
        assert_eq!(status, IRRADIA_ERROR_INTERNAL);
    }
}
