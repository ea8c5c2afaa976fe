//! Descriptors of the message types that cosfly defines, from lists of fields.

use prost::Message;
use prost_types::field_descriptor_proto::{Label, Type};
use prost_types::{DescriptorProto, FieldDescriptorProto, FileDescriptorProto, FileDescriptorSet};

/// Name, type, repetition and meaning of a field; its number is its position in the list, from 1.
pub type Field<'a> = (&'a str, Type, bool, &'a str);

/// Encoded `FileDescriptorSet` of a message of the package `cosfly`.
pub fn descriptor_set(name: &str, fields: &[Field<'_>]) -> Vec<u8> {
    let field = |(i, (name, kind, repeated, _)): (usize, &Field<'_>)| FieldDescriptorProto {
        name: Some((*name).into()),
        number: Some(i as i32 + 1),
        label: Some(if *repeated { Label::Repeated } else { Label::Optional } as i32),
        r#type: Some(*kind as i32),
        ..FieldDescriptorProto::default()
    };
    let message = DescriptorProto {
        name: Some(name.into()),
        field: fields.iter().enumerate().map(field).collect(),
        ..DescriptorProto::default()
    };
    let file = FileDescriptorProto {
        name: Some("cosfly.proto".into()),
        package: Some("cosfly".into()),
        message_type: vec![message],
        syntax: Some("proto3".into()),
        ..FileDescriptorProto::default()
    };
    FileDescriptorSet { file: vec![file] }.encode_to_vec()
}
