/// @file
/// Adds animations to an avatar's glTF file and leaves the rest unchanged.
///
///     auto bytes = ...;  // me.glb
///     Result<AnimatedFile> file = animate_file(bytes, {{"talk", filled_clip}});
///     write(file->front), write(file->middle), write(file->back);
///
/// Every byte of the file is preserved: its JSON with the order of members and the formatting of
/// numbers, its buffers, pictures, extensions. New entries are appended to `accessors`,
/// `bufferViews` and `animations`, new data to the binary chunk of a .glb or, in a .gltf, as an
/// additional embedded buffer. `.vrm` is a .glb.
///
/// An animation has, with a key at each frame of the clip,
/// - `weights` of each node whose mesh has shapes that are used (read_head.h), with the weights
///   of head::control_values(); other targets keep the weights of node or mesh;
///
