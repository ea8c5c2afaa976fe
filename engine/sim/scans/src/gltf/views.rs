//! Accessors and views of buffers, as a glTF file states them.

use crate::scalar::Scalar;
use serde::Deserialize;
use std::collections::BTreeMap;

/// Code of real numbers of 4 bytes.
pub(super) const REAL: u32 = 5126;

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Accessor {
    pub(super) buffer_view: Option<usize>,
    pub(super) byte_offset: usize,
    pub(super) component_type: u32,
    pub(super) count: usize,
    pub(super) normalized: bool,
    #[serde(rename = "type")]
    pub(super) kind: String,
    pub(super) sparse: Option<Sparse>,
}

/// Elements that differ from those of the buffer view, or from zero.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Sparse {
    pub(super) count: usize,
    pub(super) indices: Place,
    pub(super) values: Place,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Place {
    pub(super) buffer_view: usize,
    pub(super) byte_offset: usize,
    pub(super) component_type: u32,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct View {
    pub(super) buffer: usize,
    pub(super) byte_offset: usize,
    pub(super) byte_length: usize,
    pub(super) byte_stride: Option<usize>,
    pub(super) extensions: ViewExtensions,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct ViewExtensions {
    #[serde(rename = "KHR_meshopt_compression", alias = "EXT_meshopt_compression")]
    pub(super) stream: Option<Stream>,
}

/// Bytes of a view as meshoptimizer packed them.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Stream {
    pub(super) buffer: usize,
    pub(super) byte_offset: usize,
    pub(super) byte_length: usize,
    pub(super) byte_stride: usize,
    pub(super) count: usize,
    pub(super) mode: String,
    pub(super) filter: String,
}

/// Accessors of the places of a mesh that stands in many.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Instances {
    pub(super) attributes: BTreeMap<String, usize>,
}

/// A shape that Draco packed: where, and which of the packed numbers are which attribute.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Packed {
    pub(super) buffer_view: usize,
    pub(super) attributes: BTreeMap<String, u32>,
}

impl Accessor {
    /// The number that counts as 1.
    pub(super) fn greatest(&self) -> f64 {
        match scalar(self.component_type) {
            Some(Scalar::Signed(bytes)) if self.normalized => (1_u64 << (8 * bytes - 1)) as f64 - 1.0,
            Some(Scalar::Unsigned(bytes)) if self.normalized => (1_u64 << (8 * bytes)) as f64 - 1.0,
            _ => 1.0,
        }
    }
}

/// Whether an attribute of a shape is one that readers ask for.
pub(super) fn is_read(attribute: &str) -> bool {
    ["POSITION", "COLOR_0"].contains(&attribute) || attribute.starts_with("TEXCOORD_")
}

/// A kind of numbers.
pub(super) fn scalar(component_type: u32) -> Option<Scalar> {
    Some(match component_type {
        5120 => Scalar::Signed(1),
        5122 => Scalar::Signed(2),
        REAL => Scalar::Real(4),
        _ => return scalar_of_index(component_type),
    })
}

/// A kind of numbers of corners.
pub(super) fn scalar_of_index(component_type: u32) -> Option<Scalar> {
    Some(match component_type {
        5121 => Scalar::Unsigned(1),
        5123 => Scalar::Unsigned(2),
        5125 => Scalar::Unsigned(4),
        _ => return None,
    })
}
