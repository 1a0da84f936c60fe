//! What is in the file of a picture, for all crates, by path.

use std::collections::HashMap;
use std::path::Path;

/// Asserts that a file is a PNG that can be decoded to its end and shows something on a background.
pub(crate) fn assert_shows_something(path: &Path) {
    let at = path.display();
    let file = std::fs::File::open(path).unwrap_or_else(|error| panic!("{at}: {error}"));
    let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let frame = reader.next_frame(&mut bytes).unwrap_or_else(|error| panic!("{at}: {error}"));
    assert!(frame.width >= 400 && frame.height >= 200, "{at}: {} by {}", frame.width, frame.height);
    let mut colours = HashMap::new();
    for pixel in bytes[..frame.buffer_size()].chunks_exact(frame.color_type.samples()) {
        *colours.entry(pixel).or_insert(0_usize) += 1;
    }
    let all = frame.width as usize * frame.height as usize;
    let ink = all - colours.values().max().unwrap();
    // Frame, numbers and labels alone are some percent of a picture, in shades of one ink; a curve has its own.
    assert!(colours.len() > 20 && 100 * ink > all, "{at}: {} colours, {ink} of {all}", colours.len());
}
