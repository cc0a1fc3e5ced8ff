//! x
pub fn print(_out: &mut dyn std::io::Write) -> Result<(), String> { Ok(()) }
