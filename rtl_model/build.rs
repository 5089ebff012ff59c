//! Build: `sv/stitch.sv` in, an archive for the lock-step test out. With the feature `verilator`
//! only.
//!
//! Verilator makes C++ of the hardware and `cc` compiles it; the archive is linked into the tests
//! of this package and into nothing else. Where there is no Verilator the test is told so, and says
//! SKIPPED; a Verilator that refuses the file is an error.

fn main() {
    println!("cargo::rustc-check-cfg=cfg(verilated)");
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=sv");
    #[cfg(feature = "verilator")]
    verilated::build();
}

#[cfg(feature = "verilator")]
mod verilated {
    use std::path::{Path, PathBuf};
    use std::process::Command;

    pub(crate) fn build() {
        let out = PathBuf::from(std::env::var_os("OUT_DIR").expect("cargo sets it")).join("stitch");
        // Cargo keeps the folder from build to build: what Verilator no longer makes must go.
        let _ = std::fs::remove_dir_all(&out);
        match Command::new("verilator").args(["--getenv", "VERILATOR_ROOT"]).output() {
            Ok(found) if found.status.success() => {
                let root = String::from_utf8(found.stdout).expect("a path in UTF-8");
                translate(&out);
                compile(&out, &Path::new(root.trim()).join("include"));
                println!("cargo::rustc-cfg=verilated");
            }
            Ok(found) => skip(&found.status.to_string()),
            Err(error) => skip(&error.to_string()),
        }
    }

    fn skip(reason: &str) {
        println!("cargo::rustc-env=NOT_VERILATED=verilator: {reason}");
        // A file that does not exist: looked for in every build, so Verilator may come later.
        println!("cargo::rerun-if-changed=sv/no-verilator");
    }

    /// SystemVerilog to C++, with every warning an error.
    fn translate(out: &Path) {
        let status = Command::new("verilator")
            .args([
                "--cc",
                "-Wall",
                "-O3",
                "--top-module",
                "stitch",
                "--prefix",
                "Vstitch",
                "--Mdir",
            ])
            .arg(out)
            .arg("sv/stitch.sv")
            .status();
        assert!(status.expect("verilator ran before").success(), "verilator refuses stitch.sv");
    }

    fn compile(out: &Path, include: &Path) {
        let made = std::fs::read_dir(out).expect("verilator made it");
        let made = made.map(|entry| entry.expect("readable").path());
        let mut sources: Vec<_> =
            made.filter(|path| path.extension().is_some_and(|e| e == "cpp")).collect();
        sources.sort();
        let archive = "stitch_rtl";
        cc::Build::new()
            .cpp(true)
            .std("c++17")
            .opt_level(3)
            .cargo_metadata(false) // it would be linked into the library too
            .warnings(false) // of generated code
            .include(out)
            .include(include)
            .include(include.join("vltstd"))
            .define("VM_COVERAGE", "0")
            .define("VM_TRACE", "0")
            .define("VL_THREADED", "0")
            .files(sources)
            .file(include.join("verilated.cpp"))
            .file(include.join("verilated_threads.cpp"))
            .file("sv/stitch_shim.cpp")
            .compile(archive);
        let folder = std::env::var("OUT_DIR").expect("cargo sets it");
        for argument in [&format!("{folder}/lib{archive}.a"), "-lstdc++", "-lpthread"] {
            println!("cargo::rustc-link-arg-tests={argument}");
        }
    }
}
