//! A machine without any driver, made by hiding all of them from a process of its own.

use std::process::Command;

use shadewright_runtime::gpu::{Gpu, GpuError};

/// Catches a panic where there is no driver, and advice that does not name the package to install.
#[test]
fn no_driver_is_an_error_with_advice() {
    if std::env::var_os("SHADEWRIGHT_TEST_WITHOUT_DRIVER").is_some() {
        let error = Gpu::headless().unwrap_err();
        assert!(
            matches!(&error, GpuError::NoAdapter { advice, .. } if advice.contains("apt-get install mesa-vulkan-drivers")),
            "{error:?}"
        );
        return;
    }
    let child = |variables: &[(&str, &str)]| {
        let this = std::env::current_exe().unwrap();
        Command::new(this)
            .args(["--exact", "no_driver_is_an_error_with_advice"])
            .env("SHADEWRIGHT_TEST_WITHOUT_DRIVER", "1")
            .envs(variables.iter().copied())
            .output()
            .unwrap()
    };
    let hidden = [
        ("VK_ICD_FILENAMES", "/nonexistent"),
        ("VK_DRIVER_FILES", "/nonexistent"),
        ("WGPU_BACKEND", "vulkan"),
    ];
    for variables in [&hidden[..], &[("WGPU_ADAPTER_NAME", "no adapter has this name")]] {
        let output = child(variables);
        assert!(
            output.status.success(),
            "{variables:?}: {}",
            String::from_utf8_lossy(&output.stdout)
        );
    }
}

/// Catches the other test passing on a machine that has no driver anyway: there its child would find none without hiding.
#[test]
fn the_same_machine_has_a_driver() {
    Gpu::headless().unwrap();
}
