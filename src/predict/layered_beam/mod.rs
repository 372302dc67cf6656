//! Beams of layers held together by rivets or bolts, whose interfaces slip a little and so damp (Kavi).
