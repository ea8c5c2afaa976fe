//! [`Atlas`]: the pictures of all patches on a few large pages.

use crate::patch::Patch;

/// Side of a page, pixels: readers of meshes take up to 8,192.
const PAGE: usize = 4096;

/// Pictures on pages, in rows of falling height.
pub struct Atlas {
    /// Page of each patch, and the place of its upper left pixel there.
    pub places: Vec<(usize, [usize; 2])>,
    /// Heights of the pages, pixels.
    heights: Vec<usize>,
}

impl Atlas {
    pub fn new(patches: &[Patch]) -> Self {
        let mut order: Vec<usize> = (0..patches.len()).collect();
        order.sort_by_key(|at| (core::cmp::Reverse(patches[*at].size[1]), *at));
        let (mut places, mut heights) = (vec![(0, [0; 2]); patches.len()], vec![0]);
        let (mut corner, mut row_height) = ([0, 0], 0);
        for at in order {
            let [width, height] = patches[at].size;
            if corner[0] + width > PAGE {
                corner = [0, corner[1] + row_height];
                row_height = 0;
            }
            if corner[1] + height > PAGE {
                heights.push(0);
                (corner, row_height) = ([0, 0], 0);
            }
            let page = heights.len() - 1;
            places[at] = (page, corner);
            row_height = row_height.max(height);
            heights[page] = heights[page].max(corner[1] + height);
            corner[0] += width;
        }
        Self { places, heights }
    }

    /// Width and height of a page, pixels.
    pub fn size(&self, page: usize) -> [usize; 2] {
        [PAGE, self.heights[page]]
    }

    /// All pages as PNG files.
    pub fn pages(&self, patches: &[Patch]) -> Result<Vec<Vec<u8>>, png::EncodingError> {
        let page = |(number, height): (usize, &usize)| {
            let mut rgb = vec![0; 3 * PAGE * height];
            for (patch, (_, [left, top])) in patches.iter().zip(&self.places).filter(|(_, place)| place.0 == number) {
                for (row, pixels) in patch.rgb.chunks_exact(patch.size[0]).enumerate() {
                    let first = 3 * ((top + row) * PAGE + left);
                    rgb[first..first + 3 * pixels.len()].copy_from_slice(pixels.as_flattened());
                }
            }
            let mut bytes = vec![];
            let mut encoder = png::Encoder::new(&mut bytes, PAGE as u32, *height as u32);
            encoder.set_color(png::ColorType::Rgb);
            let mut writer = encoder.write_header()?;
            writer.write_image_data(&rgb)?;
            writer.finish()?;
            Ok(bytes)
        };
        self.heights.iter().enumerate().filter(|(_, height)| **height > 0).map(page).collect()
    }
}
