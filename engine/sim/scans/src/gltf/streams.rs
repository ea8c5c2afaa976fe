//! Views that meshoptimizer packed, as plain ones of further buffers.

use super::document::Document;
use super::meshopt::unpacked;
use super::views::View;
use cosfly_town::MapError;

impl Document {
    /// Whether a buffer only stands for what packed views hold: its own bytes are another form of them, or none.
    pub(super) fn stands_for_packed(&self, buffer: usize) -> bool {
        let mut views = self.buffer_views.iter().filter(|view| view.buffer == buffer).peekable();
        views.peek().is_some() && views.all(|view| view.extensions.stream.is_some())
    }

    /// Unpacks all packed views, into no more bytes than are left.
    pub(super) fn unpack_views(&mut self, left: &mut u64) -> Result<(), MapError> {
        let mut views = std::mem::take(&mut self.buffer_views);
        for (at, view) in views.iter_mut().enumerate() {
            let Some(stream) = view.extensions.stream.take() else { continue };
            let damaged = |why: &str| {
                let error = MapError::new(format!("view {at}, packed by meshoptimizer, cannot be unpacked: {why}"));
                error.hint("`gltf-transform cp FILE plain.glb` unpacks shapes, or export the file without compression")
            };
            let place = View {
                buffer: stream.buffer,
                byte_offset: stream.byte_offset,
                byte_length: stream.byte_length,
                ..View::default()
            };
            let packed = self.viewed(&place).ok_or_else(|| damaged("its bytes are not in the file"))?;
            let size = stream.count.checked_mul(stream.byte_stride);
            let size = size.filter(|size| *size as u64 <= *left);
            let size = size.ok_or_else(|| damaged("it holds more than a file of this size does"))?;
            let plain = unpacked(&stream.mode, &stream.filter, packed, stream.count, stream.byte_stride);
            let plain = plain.ok_or_else(|| damaged("its stream or its filter is not one of the extension"))?;
            *left -= size as u64;
            *view =
                View { buffer: self.data.len(), byte_length: size, byte_stride: view.byte_stride, ..View::default() };
            self.data.push(plain);
        }
        self.buffer_views = views;
        Ok(())
    }
}
