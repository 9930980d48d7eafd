//! A grid as a GeoTIFF: OGC GeoTIFF 1.1 (19-008r4), one band of 32-bit floating point, not a number where blank.

use std::io::Cursor;

use tiff::encoder::colortype::Gray32Float;
use tiff::encoder::compression::DeflateLevel;
use tiff::encoder::{Compression, TiffEncoder};
use tiff::tags::Tag;

use crate::error::ExportError;

/// Values on a regular grid of square cells of a projected system in metres.
#[derive(Clone, Copy, Debug)]
pub struct Raster<'a> {
    /// Its code in the register of EPSG.
    pub epsg: u16,
    /// Easting of the western edge, m.
    pub west_m: f64,
    /// Northing of the northern edge, m.
    pub north_m: f64,
    /// Side of a cell, m.
    pub cell_m: f64,
    /// Cells from west to east.
    pub width: usize,
    /// Rows, from north to south, each from west to east.
    pub values: &'a [f32],
}

/// GTModelTypeGeoKey and its value for a projected system.
const MODEL: [u16; 2] = [1024, 1];
/// GTRasterTypeGeoKey and its value for values of areas, not of points.
const RASTER: [u16; 2] = [1025, 1];
/// ProjectedCRSGeoKey.
const PROJECTED: u16 = 3072;
/// ProjLinearUnitsGeoKey and the metre.
const UNITS: [u16; 2] = [3076, 9001];

/// The bytes of the file.
///
/// # Errors
///
/// When the library that encodes it refuses.
pub fn geotiff(raster: &Raster<'_>) -> Result<Vec<u8>, ExportError> {
    let mut bytes = Cursor::new(Vec::new());
    write(raster, &mut bytes).map_err(ExportError::encoding("GeoTIFF"))?;
    Ok(bytes.into_inner())
}

fn write(raster: &Raster<'_>, bytes: &mut Cursor<Vec<u8>>) -> tiff::TiffResult<()> {
    let height = raster.values.len() / raster.width.max(1);
    let [width, height] = [raster.width, height].map(u32::try_from);
    // Most of a map is blank.
    let compression = Compression::Deflate(DeflateLevel::Balanced);
    let mut encoder = TiffEncoder::new(bytes)?.with_compression(compression);
    let mut image = encoder.new_image::<Gray32Float>(width?, height?)?;
    let scale = [raster.cell_m, raster.cell_m, 0.0];
    let corner = [0.0, 0.0, 0.0, raster.west_m, raster.north_m, 0.0];
    // Version 1.1.0 with four keys, each in the directory itself.
    let mut keys = vec![1, 1, 1, 4];
    for [key, value] in [MODEL, RASTER, [PROJECTED, raster.epsg], UNITS] {
        keys.extend([key, 0, 1, value]);
    }
    image.encoder().write_tag(Tag::ModelPixelScaleTag, &scale[..])?;
    image.encoder().write_tag(Tag::ModelTiepointTag, &corner[..])?;
    image.encoder().write_tag(Tag::GeoKeyDirectoryTag, &keys[..])?;
    image.encoder().write_tag(Tag::GdalNodata, "nan")?;
    image.write_data(raster.values)
}

#[cfg(test)]
mod tests {
    use super::*;
    use tiff::decoder::{Decoder, DecodingResult};

    #[test]
    fn its_values_and_its_place_come_back() {
        let values: Vec<f32> = (0..12).map(|at| if at == 5 { f32::NAN } else { at as f32 / 4.0 }).collect();
        let raster =
            Raster { epsg: 32632, west_m: 597_000.0, north_m: 6_018_000.5, cell_m: 2.5, width: 4, values: &values };
        let bytes = geotiff(&raster).unwrap();
        let mut decoder = Decoder::new(Cursor::new(bytes)).unwrap();
        assert_eq!(decoder.dimensions().unwrap(), (4, 3));
        let corner = decoder.get_tag_f64_vec(Tag::ModelTiepointTag).unwrap();
        assert_eq!(corner, [0.0, 0.0, 0.0, 597_000.0, 6_018_000.5, 0.0]);
        let keys = decoder.get_tag_u16_vec(Tag::GeoKeyDirectoryTag).unwrap();
        assert_eq!(keys[4..], [1024, 0, 1, 1, 1025, 0, 1, 1, 3072, 0, 1, 32632, 3076, 0, 1, 9001]);
        let DecodingResult::F32(read) = decoder.read_image().unwrap() else { panic!("other numbers") };
        assert_eq!(
            read.iter().map(|v| v.to_bits()).collect::<Vec<_>>(),
            values.iter().map(|v| v.to_bits()).collect::<Vec<_>>()
        );
    }
}
