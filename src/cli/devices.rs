//! `irradia devices`: the Vulkan devices, their limits, and why one cannot be used.

use anyhow::{Result, bail};
use clap::Args;
use irradia::renderer::{Context, DeviceReport};

use super::invocation::Invocation;

/// List the Vulkan devices; the default is marked with a star
#[derive(Debug, Args)]
pub(crate) struct DevicesArgs {}

/// A paragraph a device. That there is none is a failure, for nothing else would work.
pub(crate) fn run(_: &DevicesArgs, invocation: &Invocation<'_>) -> Result<()> {
    let devices = Context::devices()?;
    if devices.is_empty() {
        bail!(
            "there is no Vulkan device; install a driver, such as mesa-vulkan-drivers, which also has one for the CPU"
        );
    }
    invocation.terminal.print(&devices.iter().map(paragraph).collect::<String>())
}

fn paragraph(device: &DeviceReport) -> String {
    let mark = if device.default { '*' } else { ' ' };
    let DeviceReport { index, name, kind, driver, api, .. } = device;
    let mut text = format!("{mark} {index}  {name}\n     {kind}, {driver}, Vulkan {api}\n");
    if let Some(reason) = &device.unfit {
        text += &format!("     unfit: {reason}\n");
    }
    for of_method in device.lacks.chunk_by(|(one, _), (next, _)| one == next) {
        let ((method, what), more) = (&of_method[0], of_method.len() - 1);
        let more = if more > 0 { format!(", and {more} more") } else { String::new() };
        text += &format!("     cannot run {method}: {what}{more}\n");
    }
    let width = device.limits.iter().map(|(limit, _)| limit.chars().count()).max().unwrap_or_default();
    for (limit, value) in &device.limits {
        text += &format!("     {limit:width$}  {value}\n");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_paragraph_says_all_there_is() {
        let device = DeviceReport {
            index: 1,
            name: "llvmpipe".to_owned(),
            kind: "cpu".to_owned(),
            driver: "Mesa 25.0.7".to_owned(),
            api: "1.4.305".to_owned(),
            limits: vec![
                ("image side".to_owned(), "16384".to_owned()),
                ("push constants".to_owned(), "256 B".to_owned()),
            ],
            lacks: vec![(
                "photons".to_owned(),
                "photons/land needs 7 storage buffers in a stage (4 are offered)".to_owned(),
            )],
            unfit: Some("it has no timestamps".to_owned()),
            default: true,
        };
        let expected = "* 1  llvmpipe\n     cpu, Mesa 25.0.7, Vulkan 1.4.305\n     unfit: it has no timestamps\n     cannot run photons: photons/land needs 7 storage buffers in a stage (4 are offered)\n     image side      16384\n     push constants  256 B\n";
        assert_eq!(paragraph(&device), expected);
    }
}
