//! `cosfly plugin new`: the beginning of a plugin, as a project that builds.

use crate::command::{Command, Outcome};
use crate::console::Console;
use crate::exit;
use clap::{Parser, ValueEnum};
use cosfly_cluster::shell_word;
use cosfly_diagnose::{Diagnostic, Fault};
use cosfly_whole::{Appeared, NewFolder};
use std::fs;
use std::path::{Path, PathBuf};

/// Paths below `plugins/sdk` and the texts there.
macro_rules! sdk {
    ($($path:literal),* $(,)?) => {
        [$(($path, include_str!(concat!("../../../../../plugins/sdk/", $path)))),*]
    };
}
/// The kit for plugins.
const SDK: [(&str, &str); 17] = sdk![
    "Cargo.toml",
    "src/lib.rs",
    "src/abi.rs",
    "src/arrow_stream.rs",
    "src/cost_term.rs",
    "src/flatbuffers.rs",
    "src/flight.rs",
    "src/geometry.rs",
    "src/json.rs",
    "src/log.rs",
    "src/objective.rs",
    "src/params.rs",
    "src/random.rs",
    "src/recent_blocks.rs",
    "src/running.rs",
    "src/stage.rs",
    "src/town.rs",
];
const MANIFEST: &str = include_str!("../../../../../plugins/templates/Cargo.toml.txt");
/// Vectors are part of WebAssembly, but the compiler wants to be told; calls cost more in it than in native code.
const CARGO_CONFIG: &str = "[target.wasm32-unknown-unknown]\nrustflags = [\"-Ctarget-feature=+simd128\", \"-Cllvm-args=-inline-threshold=1000\"]\n";
const README: &str = include_str!("../../../../../plugins/templates/README.md.txt");

/// Write the beginning of a plugin: a Rust project that builds
#[derive(Debug, Parser)]
#[command(name = "new", after_help = "Example:\n  cosfly plugin new --kind cost-term keep_low")]
pub struct Arguments {
    /// Kind of the plugin
    #[arg(long, value_enum)]
    kind: PluginKind,
    /// Folder to write, with the name of the plugin
    #[arg(value_name = "NAME")]
    path: PathBuf,
}

/// Kinds of plugins.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum PluginKind {
    /// A cost of a flight
    CostTerm,
    /// Targets to look at, with viewpoints and times
    Objective,
    /// A filter or labels of finished flights
    Stage,
}

impl Command for Arguments {
    fn run(&self, console: &dyn Console) -> Outcome {
        new(self, console)
    }
}

/// Writes the project and says how to go on.
fn new(arguments: &Arguments, console: &dyn Console) -> Outcome {
    let name = arguments.path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    let is_plain = |byte: u8| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'_';
    let begins = name.bytes().next().is_some_and(|byte| byte.is_ascii_lowercase());
    if !begins || name.len() > 60 || !name.bytes().all(is_plain) {
        let message = format!("a plugin cannot be called `{name}`");
        return Err(Diagnostic::new("plugin-name", Fault::Recipe, message)
            .hint("names begin with `a-z` and go on with at most 59 of `a-z`, `0-9` and `_`")
            .into());
    }
    if arguments.path.exists() || write(arguments, name)? == Appeared::Taken {
        let message = format!("`{}` is there already", arguments.path.display());
        return Err(Diagnostic::new("plugin-exists", Fault::Recipe, message)
            .hint("choose another name or folder")
            .into());
    }
    let built = format!("target/wasm32-unknown-unknown/release/{name}.wasm");
    console.print(&format!(
        "wrote `{0}`: what it does is in `{0}/src/lib.rs`. Then:\n  cd {1}\n  cargo test\n  cargo build --release --target \
         wasm32-unknown-unknown     (once before: rustup target add wasm32-unknown-unknown)\n  cosfly plugin check {built}\n",
        arguments.path.display(),
        shell_word(&arguments.path.to_string_lossy())
    ))?;
    Ok(exit::SUCCESS)
}

/// Writes the files beside the folder first, so that the folder is whole when it appears.
fn write(arguments: &Arguments, name: &str) -> cosfly_diagnose::Result<Appeared> {
    let (source, words, usage) = match arguments.kind {
        PluginKind::CostTerm => (
            include_str!("../../../../../plugins/templates/cost-term.rs.txt"),
            "cost term",
            "    [[stages.expert.terms]]\n    use = \"wasm:NAME.wasm\"\n    weight = 1.0\n    params = { free_m = 25.0 }\n",
        ),
        PluginKind::Objective => (
            include_str!("../../../../../plugins/templates/objective.rs.txt"),
            "objective",
            "    [stages.expert]\n    use = \"plan\"\n    inputs.town = \"town\"\n    objective = \"plugin\"\n\n    [stages.expert.plugin]\n    use = \"wasm:NAME.wasm\"\n    count = 1\n",
        ),
        PluginKind::Stage => (
            include_str!("../../../../../plugins/templates/stage.rs.txt"),
            "stage",
            "    [stages.kept]\n    use = \"wasm:NAME.wasm\"\n    inputs = { town = \"town\", trajectories = \"expert\" }\n",
        ),
    };
    let named = |text: &str| text.replace("NAME", name);
    let refused = |error: std::io::Error| Diagnostic::io(format!("write `{}`", arguments.path.display()), &error);
    let draft = NewFolder::beside(&arguments.path).map_err(refused)?;
    put(&draft.path().join("Cargo.toml"), &named(MANIFEST))?;
    put(&draft.path().join("src/lib.rs"), &named(source))?;
    put(&draft.path().join("README.md"), &named(&README.replace("KIND", words).replace("USE", usage)))?;
    put(&draft.path().join(".cargo/config.toml"), CARGO_CONFIG)?;
    put(&draft.path().join(".gitignore"), "/target\n")?;
    for (file, text) in SDK {
        put(&draft.path().join("sdk").join(file), text)?;
    }
    draft.appear().map_err(refused)
}

fn put(path: &Path, text: &str) -> cosfly_diagnose::Result<()> {
    let refused = |error: std::io::Error| Diagnostic::io(format!("write `{}`", path.display()), &error);
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(refused)?;
    }
    fs::write(path, text).map_err(refused)
}
