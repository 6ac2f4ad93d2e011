//! The renderer's meshes: vertices as its own buffers have them.

use std::f32::consts::TAU;

/// A vertex: position in m, normal of unit length.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Corner {
    /// Object space, m.
    pub position: [f32; 3],
    /// Object space, unit length.
    pub normal: [f32; 3],
}

/// Triangles, counter-clockwise from the front.
#[derive(Clone, Debug)]
pub struct Mesh {
    /// Corners.
    pub vertices: Vec<Corner>,
    /// Three for each triangle.
    pub indices: Vec<u32>,
}

impl Mesh {
    /// A ring around the y axis with this many segments around it and around its own circle: radii 1 m and 0.4 m.
    pub fn ring(around: u32, across: u32) -> Self {
        let (mut vertices, mut indices) = (Vec::new(), Vec::new());
        for i in 0..around {
            let (sin, cos) = (TAU * i as f32 / around as f32).sin_cos();
            for j in 0..across {
                let (up, out) = (TAU * j as f32 / across as f32).sin_cos();
                let radius = 1.0 + 0.4 * out;
                vertices.push(Corner {
                    position: [radius * cos, 0.4 * up, radius * sin],
                    normal: [out * cos, up, out * sin],
                });
                let corner = |i: u32, j: u32| (i % around) * across + j % across;
                let quad = [corner(i, j), corner(i, j + 1), corner(i + 1, j + 1), corner(i + 1, j)];
                indices.extend([quad[0], quad[1], quad[2], quad[0], quad[2], quad[3]]);
            }
        }
        Self { vertices, indices }
    }

    /// A square of 2 m in the plane z = 0 that faces +z.
    pub fn square() -> Self {
        let corner = |x, y| Corner {
            position: [x, y, 0.0],
            normal: [0.0, 0.0, 1.0],
        };
        Self {
            vertices: vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
            indices: vec![0, 1, 2, 0, 2, 3],
        }
    }
}
