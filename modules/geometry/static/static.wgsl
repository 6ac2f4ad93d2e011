/// The vertex as it is in the mesh.
fn deform(v: Vertex) -> Vertex {
    return v;
}
