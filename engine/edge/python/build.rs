//! Links the library of the wheel: functions of the same code are kept once, which saves a sixteenth of the wheel.

fn main() {
    let target = |name: &str| std::env::var(format!("CARGO_CFG_TARGET_{name}")).unwrap_or_default();
    // Where Rust brings its own linker, which can do so.
    if target("OS") == "linux" && target("ARCH") == "x86_64" && target("ENV") == "gnu" {
        println!("cargo::rustc-cdylib-link-arg=-Wl,--icf=all");
    }
    println!("cargo::rerun-if-changed=build.rs");
}
