//! PLY, as text or in numbers: the elements `vertex` (x, y, z) and `face` (a list `vertex_indices`, or `vertex_index`); other elements are left
//! out, and counted.

use std::io::Cursor;

use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{DefaultElement, ElementDef, Encoding, Header, Property};

use super::{Triangles, at_line, corner, finite};
use crate::{Trouble, text};

/// Where the elements of a kind begin.
struct Place {
    byte: u64,
    line: usize,
}

/// The file, and how far it was read.
struct File<'a> {
    bytes: &'a [u8],
    parser: Parser<DefaultElement>,
    reader: Reader<Cursor<&'a [u8]>>,
}

impl<'a> File<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, parser: Parser::new(), reader: Reader::new(Cursor::new(bytes)) }
    }

    fn place(&self) -> Place {
        Place { byte: self.reader.get_ref().position(), line: self.reader.line() }
    }

    /// What the library says, where: the line, and what it is, or the byte. `in_text`: up to here the file is text.
    fn words(&self, error: &ParseError, in_text: bool) -> Trouble {
        let (words, at) = (error.to_string(), self.place());
        let words = words.lines().next().unwrap_or_default();
        let words = words.split_once(": ").filter(|_| error.line().is_some()).map_or(words, |(_, words)| words);
        if !in_text {
            return format!("byte {}: {words}", at.byte);
        }
        let line = error.line().unwrap_or_else(|| text::line(self.bytes, (at.byte as usize).saturating_sub(1)));
        format!("{}: {words}", at_line(self.bytes, line))
    }

    fn elements(&mut self, header: &Header, of: &ElementDef) -> Result<Vec<DefaultElement>, Trouble> {
        let read = self.parser.read_payload_for_element(&mut self.reader, of, header);
        read.map_err(|error| self.words(&error, header.encoding == Encoding::Ascii))
    }

    /// Where element `index` of a kind is, which begins there: a line each; in numbers, what is before it is read again.
    fn of(&self, header: &Header, of: &ElementDef, begin: &Place, index: usize) -> String {
        if header.encoding == Encoding::Ascii {
            return format!("line {}", begin.line + index);
        }
        let mut before = Reader::new(Cursor::new(self.bytes));
        before.get_mut().set_position(begin.byte);
        let of = ElementDef { count: index, ..of.clone() };
        let _ = self.parser.read_payload_for_element(&mut before, &of, header);
        format!("byte {}, {} {index}", before.get_ref().position(), of.name)
    }
}

pub fn read(bytes: &[u8]) -> Result<Triangles, Trouble> {
    let mut file = File::new(bytes);
    let header = file.parser.read_header(&mut file.reader).map_err(|error| file.words(&error, true))?;
    let mut mesh = Triangles::default();
    let mut faces = None;
    for (name, of) in &header.elements {
        let begin = file.place();
        let elements = file.elements(&header, of)?;
        match name.as_str() {
            "vertex" => {
                for (i, vertex) in elements.iter().enumerate() {
                    let x = position(vertex)
                        .map_err(|trouble| format!("{}: {trouble}", file.of(&header, of, &begin, i)))?;
                    mesh.vertices.push(x);
                }
            }
            "face" => faces = Some((elements, of, begin)),
            _ => mesh.left_out.add(name, elements.len()),
        }
    }
    if !header.elements.contains_key("vertex") {
        return Err("the header has no element `vertex`".into());
    }
    let (elements, of, begin) = faces.ok_or("the header has no element `face`")?;
    for (i, face) in elements.iter().enumerate() {
        let corners = polygon(face, mesh.vertices.len());
        mesh.push_polygon(&corners.map_err(|trouble| format!("{}: {trouble}", file.of(&header, of, &begin, i)))?);
    }
    let end = file.place().byte as usize;
    match bytes[end..].iter().position(|c| !c.is_ascii_whitespace()) {
        Some(more) if header.encoding == Encoding::Ascii => {
            Err(format!("line {}: here is more than the header counts", text::line(bytes, end + more)))
        }
        Some(_) => Err(format!("byte {end}: here is more than the header counts")),
        None => Ok(mesh),
    }
}

fn position(vertex: &DefaultElement) -> Result<[f64; 3], Trouble> {
    let x = ["x", "y", "z"].map(|axis| vertex.get(axis).and_then(scalar));
    let [Some(x), Some(y), Some(z)] = x else { return Err("a vertex has not the numbers x, y and z".into()) };
    finite([x, y, z])
}

fn polygon(face: &DefaultElement, vertices: usize) -> Result<Vec<u32>, Trouble> {
    let corners = face.get("vertex_indices").or(face.get("vertex_index")).and_then(indices);
    let corners = corners.ok_or("a face has no list `vertex_indices`")?;
    corners.into_iter().map(|index| corner(index, vertices)).collect()
}

fn scalar(p: &Property) -> Option<f64> {
    Some(match *p {
        Property::Char(x) => x.into(),
        Property::UChar(x) => x.into(),
        Property::Short(x) => x.into(),
        Property::UShort(x) => x.into(),
        Property::Int(x) => x.into(),
        Property::UInt(x) => x.into(),
        Property::Float(x) => x.into(),
        Property::Double(x) => x,
        _ => return None,
    })
}

fn indices(p: &Property) -> Option<Vec<i64>> {
    fn wide<I: Copy + Into<i64>>(list: &[I]) -> Vec<i64> {
        list.iter().map(|&i| i.into()).collect()
    }
    Some(match p {
        Property::ListChar(list) => wide(list),
        Property::ListUChar(list) => wide(list),
        Property::ListShort(list) => wide(list),
        Property::ListUShort(list) => wide(list),
        Property::ListInt(list) => wide(list),
        Property::ListUInt(list) => wide(list),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::super::tests::expected;
    use super::*;

    const HEAD: &str = "ply\nformat ascii 1.0\nelement vertex 5\nproperty double x\nproperty double y\nproperty double z\n\
                        element face 2\nproperty list uchar int vertex_indices\nend_header\n";
    const BODY: &str = "0 0 0\n1 0 0\n1 1 0.5\n0 1 0\n0.1 0 -1\n4 0 1 2 3\n3 1 0 4\n";

    fn in_numbers(last: i32) -> Vec<u8> {
        let head = HEAD.replace("ascii", "binary_little_endian").replace("vertex_indices", "vertex_index");
        let mut binary = head.into_bytes();
        binary.extend(expected().vertices.iter().flatten().flat_map(|x| x.to_le_bytes()));
        for polygon in [&[0i32, 1, 2, 3][..], &[1, 0, last]] {
            binary.push(polygon.len() as u8);
            binary.extend(polygon.iter().flat_map(|i| i.to_le_bytes()));
        }
        binary
    }

    #[test]
    fn in_text_and_in_numbers() {
        assert_eq!(read(format!("{HEAD}{BODY}").as_bytes()), Ok(expected()));
        assert_eq!(read(&in_numbers(4)), Ok(expected()));
    }

    #[test]
    fn trouble_names_the_line() {
        let whole = format!("{HEAD}{BODY}");
        for (from, to, says) in [
            ("3 1 0 4", "3 1 0 -4", "line 16: -4 is not the index of a vertex"),
            ("4 0 1 2 3", "4 0 1 2 5", "line 15: 5 is not the index of a vertex: there are 5, counted from 0"),
            ("1 1 0.5", "1 1 nan", "line 12"),
            ("1 1 0.5", "1 1", "line 12, `1 1`: "),
            ("1 1 0.5", "1 1 x", "line 12, `1 1 x`: "),
            ("element vertex 5", "element vertex", "line 3, `element vertex`: "),
            ("ply\n", "plx\n", "line 1, `plx`: "),
            ("property double z\n", "", "line 9"),
            ("end_header\n", "", "line 9, `0 0 0`: "),
            ("3 1 0 4\n", "", "line 16"),
            ("3 1 0 4\n", "3 1 0 4\n\n3 1 0 4\n", "line 18: here is more than the header counts"),
            ("element face 2", "element faces 2", "the header has no element `face`"),
            ("element vertex 5", "element corner 5", "the header has no element `vertex`"),
            ("vertex_indices", "corners", "line 15: a face has no list `vertex_indices`"),
            ("format ascii 1.0\n", "", "line 8, `end_header`: No format line found."),
        ] {
            assert!(whole.contains(from));
            let told = read(whole.replacen(from, to, 1).as_bytes()).unwrap_err();
            assert!(told.starts_with(says) && !told.contains('\n'), "{from} -> {to}: {told}");
        }
        let told = |text: &str| read(text.as_bytes()).unwrap_err();
        assert!(told("ply\nformat ascii 1.0\n\nelement vertex 1\n").starts_with("line 3, which is empty: "));
        assert!(told("ply\nformat ascii 1.0\n").starts_with("line 3, which is empty: Unexpected end of file"));
    }

    #[test]
    fn other_elements_are_counted() {
        let more = "property list uchar int vertex_indices\nelement edge 2\nproperty int a\nproperty int b\n";
        let head = HEAD.replace("property list uchar int vertex_indices\n", more).replace("face 2", "face 3");
        let mesh = read(format!("{head}{BODY}2 0 1\n0 1\n1 2\n").as_bytes()).unwrap();
        assert_eq!(mesh.triangles, expected().triangles);
        assert_eq!(mesh.left_out.to_string(), "1 face of fewer than three corners, 2 of `edge`");
    }

    #[test]
    fn trouble_names_the_byte() {
        let begin = in_numbers(4).len() - (5 * 24 + 17 + 13);
        let told = |bytes: &[u8]| read(bytes).err().unwrap_or_default();
        let says = format!("byte {}, face 1: 5 is not the index of a vertex", begin + 5 * 24 + 17);
        assert!(told(&in_numbers(5)).starts_with(&says), "{}", told(&in_numbers(5)));
        let mut infinite = in_numbers(4);
        infinite[begin + 3 * 24..][..8].copy_from_slice(&f64::INFINITY.to_le_bytes());
        let says = format!("byte {}, vertex 3: a coordinate is not finite", begin + 3 * 24);
        assert!(told(&infinite).starts_with(&says), "{}", told(&infinite));
        let short = &in_numbers(4)[..begin + 30];
        assert!(told(short).starts_with("byte "), "{}", told(short));
        let more = [in_numbers(4), vec![1]].concat();
        assert!(told(&more).starts_with(&format!("byte {}: here is more", more.len() - 1)), "{}", told(&more));
    }
}
