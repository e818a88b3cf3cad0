//! What people see: results on standard output; errors, warnings, log lines and progress on standard error.

use std::collections::HashSet;
use std::fmt;
use std::io::{self, IsTerminal, Write};
use std::sync::Mutex;

use anyhow::Context as _;
use indicatif::{MultiProgress, ProgressBar, ProgressDrawTarget, ProgressStyle};
use irradia::reference;
use tracing::field::{Field, Visit};
use tracing::{Event, Level, Subscriber};
use tracing_subscriber::filter::{LevelFilter, Targets};
use tracing_subscriber::fmt::format::Writer;
use tracing_subscriber::fmt::{FmtContext, FormatEvent, FormatFields, MakeWriter};
use tracing_subscriber::layer::SubscriberExt as _;
use tracing_subscriber::registry::LookupSpan;
use tracing_subscriber::util::SubscriberInitExt as _;

/// The variable that overrides which log lines appear, in the syntax of tracing-subscriber's `Targets`: `irradia=debug`.
const LOG_VARIABLE: &str = "IRRADIA_LOG";

/// How much is said.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Verbosity {
    /// Errors alone.
    Quiet,
    /// Warnings, progress, what was written.
    Normal,
    /// The same, and what is being done.
    Verbose,
    /// Whatever there is to say.
    Everything,
}

/// Standard error, shared by sentences and progress bars.
pub(crate) struct Terminal {
    verbosity: Verbosity,
    bars: MultiProgress,
}

impl Terminal {
    /// Starts logging. Progress bars are drawn on a terminal alone.
    pub(crate) fn new(verbosity: Verbosity) -> Terminal {
        let drawn = io::stderr().is_terminal() && verbosity != Verbosity::Quiet;
        let target = if drawn { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let bars = MultiProgress::with_draw_target(target);
        let level = match verbosity {
            Verbosity::Quiet => LevelFilter::ERROR,
            Verbosity::Normal => LevelFilter::WARN,
            Verbosity::Verbose => LevelFilter::INFO,
            Verbosity::Everything => LevelFilter::DEBUG,
        };
        let wanted = std::env::var(LOG_VARIABLE).ok();
        let filter = wanted.as_ref().and_then(|wanted| wanted.parse().ok());
        let misread = wanted.filter(|_| filter.is_none());
        let lines =
            tracing_subscriber::fmt::layer().with_writer(AboveBars(bars.clone())).event_format(Sentences::default());
        // A second start, as tests might do, leaves the first in place.
        let _ = tracing_subscriber::registry()
            .with(lines)
            .with(filter.unwrap_or_else(|| Targets::new().with_default(level)))
            .try_init();
        if let Some(wanted) = misread {
            tracing::warn!("{LOG_VARIABLE}={wanted} is no list of levels such as irradia=debug");
        }
        Terminal { verbosity, bars }
    }

    /// Writes a result to standard output. A reader that has gone away, as `head` does, has what it wanted.
    pub(crate) fn print(&self, text: &str) -> anyhow::Result<()> {
        let written = self.bars.suspend(|| {
            let mut out = io::stdout().lock();
            out.write_all(text.as_bytes()).and_then(|()| out.flush())
        });
        match written {
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
            written => written.context("standard output cannot be written"),
        }
    }

    /// Says what was done, unless it should be quiet.
    pub(crate) fn say(&self, text: &str) {
        if self.verbosity != Verbosity::Quiet {
            self.line(text);
        }
    }

    /// Says what went wrong.
    pub(crate) fn error(&self, text: &str) {
        self.line(&format!("irradia: {text}"));
    }

    /// A bar over `count` steps; it is cleared when dropped.
    pub(crate) fn progress(&self, count: u64) -> Progress {
        let bar = self.bars.add(ProgressBar::new(count));
        if let Ok(style) = ProgressStyle::with_template("{bar:30} {pos}/{len} {elapsed} (left: {eta}) {msg}") {
            bar.set_style(style);
        }
        Progress(bar)
    }

    fn line(&self, text: &str) {
        // Nobody is left to tell if standard error is closed.
        self.bars.suspend(|| drop(writeln!(io::stderr(), "{text}")));
    }
}

/// A progress bar.
pub(crate) struct Progress(ProgressBar);

impl Progress {
    /// What the next steps are part of.
    pub(crate) fn about(&self, what: &str) {
        self.0.set_message(what.to_owned());
    }

    /// One step is done.
    pub(crate) fn step(&self) {
        self.0.inc(1);
    }

    /// As many steps are done, however many were.
    pub(crate) fn at(&self, position: u64) {
        self.0.set_position(position);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

/// The progress of samples of a reference, which has a bar as soon as there is something to do.
pub(crate) struct Steps<'a> {
    terminal: &'a Terminal,
    about: String,
    bar: Option<Progress>,
}

impl<'a> Steps<'a> {
    pub(crate) fn new(terminal: &'a Terminal, about: &str) -> Steps<'a> {
        Steps { terminal, about: about.to_owned(), bar: None }
    }

    pub(crate) fn show(&mut self, progress: reference::Progress) {
        if progress.done == progress.total {
            self.bar = None;
            return;
        }
        let bar = self.bar.get_or_insert_with(|| {
            let bar = self.terminal.progress(u64::from(progress.total));
            bar.about(&self.about);
            bar
        });
        bar.at(u64::from(progress.done));
    }
}

/// Log lines to standard error, above the bars.
struct AboveBars(MultiProgress);

impl<'a> MakeWriter<'a> for AboveBars {
    type Writer = LineAboveBars<'a>;

    fn make_writer(&'a self) -> LineAboveBars<'a> {
        LineAboveBars(&self.0)
    }
}

struct LineAboveBars<'a>(&'a MultiProgress);

impl Write for LineAboveBars<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.suspend(|| io::stderr().write_all(bytes))?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        io::stderr().flush()
    }
}

/// Log lines as `irradia: warning: …`; the same warning comes once.
#[derive(Default)]
struct Sentences {
    said: Mutex<HashSet<String>>,
}

impl<S: Subscriber + for<'a> LookupSpan<'a>, N: for<'a> FormatFields<'a> + 'static> FormatEvent<S, N> for Sentences {
    fn format_event(&self, _: &FmtContext<'_, S, N>, mut writer: Writer<'_>, event: &Event<'_>) -> fmt::Result {
        let mut sentence = Sentence::default();
        event.record(&mut sentence);
        let level = *event.metadata().level();
        let text = sentence.message + &sentence.fields;
        match level {
            Level::ERROR => writeln!(writer, "irradia: {text}"),
            Level::WARN => {
                let new = self.said.lock().is_ok_and(|mut said| said.insert(text.clone()));
                if new { writeln!(writer, "irradia: warning: {text}") } else { Ok(()) }
            }
            _ => writeln!(writer, "irradia: {}: {text}", level.as_str().to_lowercase()),
        }
    }
}

/// The text of an event: its message, then other fields as `, name = value`.
#[derive(Default)]
struct Sentence {
    message: String,
    fields: String,
}

impl Visit for Sentence {
    fn record_str(&mut self, field: &Field, value: &str) {
        self.record_debug(field, &format_args!("{value}"));
    }

    fn record_debug(&mut self, field: &Field, value: &dyn fmt::Debug) {
        if field.name() == "message" {
            self.message = format!("{value:?}");
        } else {
            self.fields += &format!(", {} = {value:?}", field.name());
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;

    #[derive(Clone, Default)]
    struct Captured(Arc<Mutex<Vec<u8>>>);

    impl Write for Captured {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0.lock().expect("no test panics while writing").write(bytes)
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_warning_comes_once() {
        let captured = Captured::default();
        let writer = captured.clone();
        let subscriber =
            tracing_subscriber::fmt().event_format(Sentences::default()).with_writer(move || writer.clone()).finish();
        tracing::subscriber::with_default(subscriber, || {
            for name in ["a", "a", "b"] {
                tracing::warn!("{name} has no light");
                tracing::info!(triangles = 3, "loaded {name}");
            }
        });
        let bytes = captured.0.lock().expect("no test panics while writing").clone();
        let expected = "irradia: warning: a has no light\nirradia: info: loaded a, triangles = 3\n\
                        irradia: info: loaded a, triangles = 3\n\
                        irradia: warning: b has no light\nirradia: info: loaded b, triangles = 3\n";
        assert_eq!(String::from_utf8(bytes).expect("text"), expected);
    }
}
