//! The names that a core module imports and exports.

use wasmparser::{BinaryReaderError, Parser, Payload};

/// The beginning of a section that bindings generators write, before the version of its format and the encoding of texts.
const MARK: &[u8] = b"wit-component-encoding";

/// The outside of a core module.
#[derive(Debug, Default)]
pub struct CoreModule {
    /// Imported modules and functions.
    pub imports: Vec<(String, String)>,
    /// Exported names.
    pub exports: Vec<String>,
    /// Encoding of texts: 0 UTF-8, 1 UTF-16, 2 Latin-1 or UTF-16.
    pub encoding: u8,
}

impl CoreModule {
    /// Reads the names in `bytes`.
    ///
    /// # Errors
    /// The first place that is not WebAssembly.
    pub fn read(bytes: &[u8]) -> Result<Self, BinaryReaderError> {
        let mut module = Self::default();
        for payload in Parser::new(0).parse_all(bytes) {
            match payload? {
                Payload::ImportSection(section) => {
                    for import in section.into_imports() {
                        let import = import?;
                        module.imports.push((import.module.to_owned(), import.name.to_owned()));
                    }
                }
                Payload::ExportSection(section) => {
                    for export in section {
                        module.exports.push(export?.name.to_owned());
                    }
                }
                Payload::CustomSection(section) if section.name().starts_with("component-type") => {
                    module.encoding = encoding(section.data()).unwrap_or(module.encoding);
                }
                _ => {}
            }
        }
        Ok(module)
    }

    /// Whether it exports `name`.
    pub fn has(&self, name: &str) -> bool {
        self.exports.iter().any(|export| export == name)
    }
}

/// The encoding of texts that a section about interfaces names.
fn encoding(section: &[u8]) -> Option<u8> {
    let at = section.windows(MARK.len()).position(|window| window == MARK)?;
    section.get(at + MARK.len() + 1).copied()
}
