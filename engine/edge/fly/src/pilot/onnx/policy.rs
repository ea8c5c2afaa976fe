//! [`OnnxPolicy`]: a network that flies.

use super::description::{Description, Source};
use cosfly_diagnose::{Diagnostic, Fault, Result, counted};
use cosfly_fingerprint::Digest;
use cosfly_onnx::{MOST_BYTES, OnnxModel, Tensor, TensorValues};
use std::io::ErrorKind;
use std::path::Path;
use std::sync::Arc;

/// A network that flies.
#[derive(Clone)]
pub struct OnnxPolicy {
    name: String,
    bytes: Arc<[u8]>,
    digest: Digest,
    network: Arc<(OnnxModel, Description)>,
}

impl core::fmt::Debug for OnnxPolicy {
    fn fmt(&self, to: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(to, "{} {}", self.name, self.digest)
    }
}

impl PartialEq for OnnxPolicy {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name && self.digest == other.digest
    }
}

impl OnnxPolicy {
    /// The policy in a file.
    ///
    /// # Errors
    /// `fly-onnx`, with what is wrong and what is allowed; errors of the file system.
    pub fn read(path: &Path) -> Result<Self> {
        let shown = path.display();
        let failed = |error: &std::io::Error| Diagnostic::unread(format!("`{shown}`"), error);
        let refused = |rule: String| {
            Diagnostic::new("fly-onnx", Fault::Input, format!("`{shown}` is no policy in ONNX that cosfly flies"))
                .because(rule)
                .hint("the page \"Fly your ONNX policy\" of the book has the rules and an example")
        };
        let metadata = match path.metadata() {
            Err(error) if error.kind() == ErrorKind::NotFound => {
                return Err(refused("there is no such file".to_owned()));
            }
            metadata => metadata.map_err(|error| failed(&error))?,
        };
        let size = metadata.len();
        if !metadata.is_file() {
            return Err(refused("it is no file".to_owned())); // a device may have no end
        }
        if size > MOST_BYTES as u64 {
            return Err(refused(format!("it has {size}; it may have {MOST_BYTES}", size = counted(size, "byte"))));
        }
        let bytes = std::fs::read(path).map_err(|error| failed(&error))?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        Self::of_bytes(&name, bytes).map_err(refused)
    }

    /// The policy in the bytes of a file, which is tried once.
    ///
    /// # Errors
    /// The fault, and what is allowed, in words.
    pub fn of_bytes(name: &str, bytes: Vec<u8>) -> std::result::Result<Self, String> {
        let model = OnnxModel::read(&bytes)?;
        let description = Description::of(&model)?;
        let zeros = model.inputs().iter().map(|port| Tensor::zeros(port.kind, &port.shape)).collect();
        run(&model, &description, zeros)?;
        let digest = Digest::of(&bytes);
        Ok(Self { name: name.to_owned(), bytes: bytes.into(), digest, network: Arc::new((model, description)) })
    }

    /// Runs the network once.
    ///
    /// # Errors
    /// Those of [`OnnxModel::run`]; shapes of memories and actions that do not fit.
    pub fn run(&self, inputs: Vec<Tensor>) -> std::result::Result<Vec<Tensor>, String> {
        run(self.model(), self.description(), inputs)
    }

    /// Name: that of its file, without the ending.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The file.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Digest of the file.
    pub fn digest(&self) -> Digest {
        self.digest
    }

    /// The network.
    pub fn model(&self) -> &OnnxModel {
        &self.network.0
    }

    /// Description of its inputs and outputs.
    pub fn description(&self) -> &Description {
        &self.network.1
    }

    /// Names of what it sees, sorted.
    pub fn sees(&self) -> Vec<&'static str> {
        let mut names: Vec<&str> = self.description().observations().into_iter().map(|it| it.name()).collect();
        names.sort_unstable();
        names
    }
}

/// Outputs of a network, whose memories and actions have the shapes that they must have: shapes may depend on numbers.
fn run(model: &OnnxModel, description: &Description, inputs: Vec<Tensor>) -> std::result::Result<Vec<Tensor>, String> {
    let outputs = model.run(inputs)?;
    for (port, source) in model.inputs().iter().zip(&description.sources) {
        if let Source::Memory(output) = source {
            let Tensor { shape, values } = &outputs[*output];
            if *shape != port.shape || values.kind() != port.kind {
                return Err(format!(
                    "its memory `{}` has the shape {:?}, the output for it {shape:?}",
                    port.name, port.shape
                ));
            }
        }
    }
    let (kind, columns) = (description.actions.name(), description.actions.columns());
    let Tensor { shape, values } = &outputs[description.output];
    let is_row = shape.last() == Some(&columns) && matches!(values, TensorValues::Floats(_)) && !values.is_empty();
    match is_row {
        true => Ok(outputs),
        false => Err(format!(
            "its output has the shape {shape:?}; actions `{kind}` are floats of the shape ({columns}) or (n, {columns})"
        )),
    }
}
