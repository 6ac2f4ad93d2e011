//! One texel with each pipeline of a frame, for drivers that compile when they draw.
//!
//! Targets, textures and samplers are those of the frame itself: such drivers compile for their formats and sizes as well. What compute
//! passes write goes into buffers that are thrown away.

use std::collections::HashSet;
use std::sync::Arc;

use super::draw::{CASTER, Call, Drawing, scene_state};
use super::prepare::Steps;
use super::render::Made;
use super::{Draw, plan::Plan};
use crate::gpu::RuntimeError;
use crate::gpu::resources::layer_view;

impl Drawing<'_> {
    /// Draws what is least with each pipeline, one submission for each, until it is all done or stopped.
    pub fn warm(&mut self, made: &Made, steps: &Steps) -> Result<(), RuntimeError> {
        let plan: &Plan = self.plan;
        self.least = true;
        let mut warm = Warm::default();
        for (index, (map, texture)) in plan.maps.iter().zip(&made.depths).enumerate() {
            // All layers have the same casters.
            let (Some(eye), Some(list)) = (map.eyes.first(), plan.map_lists[index].first()) else {
                continue;
            };
            let look = |draw: &Draw| plan.casters.get(&(index, draw.material));
            let view = layer_view(texture, 0);
            for call in self.calls(eye, list, look, |_| CASTER)? {
                if warm.is_new(&call) {
                    self.shadow_layer(&view, std::slice::from_ref(&call), None);
                    self.submit(&mut warm, Arc::as_ptr(&call.pipeline).addr() as u128, steps)?;
                }
            }
        }
        for compute in &plan.before {
            self.dispatch(compute, None)?;
            self.submit(&mut warm, compute.look.program.hash(), steps)?;
        }
        let look = |draw: &Draw| plan.forward[draw.material].as_ref();
        for call in self.calls(&plan.eye, &plan.list, look, |draw| scene_state(draw, plan.hdr))? {
            if warm.is_new(&call) {
                self.scene_calls(&made.hdr_view, &made.depth_view, std::slice::from_ref(&call));
                self.submit(&mut warm, Arc::as_ptr(&call.pipeline).addr() as u128, steps)?;
            }
        }
        if let (Some(look), Some(texture)) = (&plan.display, &made.display) {
            for compute in &plan.after {
                self.dispatch(compute, Some(&made.hdr_view))?;
                self.submit(&mut warm, compute.look.program.hash(), steps)?;
            }
            self.display(look, texture, &made.hdr_view)?;
            self.submit(&mut warm, look.program.hash(), steps)?;
        }
        steps.finish();
        Ok(())
    }

    /// Waits until the GPU has done what was written so far. After a stop it is thrown away instead.
    fn submit(&mut self, warm: &mut Warm, of: u128, steps: &Steps) -> Result<(), RuntimeError> {
        let gpu = self.fill.gpu;
        let next = gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let commands = std::mem::replace(&mut self.commands, next);
        if steps.stopped() {
            return Ok(());
        }
        gpu.scoped("warming up", |_| {
            gpu.queue().submit([commands.finish()]);
        })?;
        gpu.wait()?;
        if warm.counted.insert(of) {
            steps.next();
        }
        Ok(())
    }
}

/// What was drawn already, by address: the plan and its pipelines live longer than this.
#[derive(Default)]
struct Warm {
    drawn: HashSet<(usize, usize)>,
    /// Pipelines by address, or programs by hash.
    counted: HashSet<u128>,
}

impl Warm {
    /// Whether this pipeline was not drawn with this material yet; another material may have textures of other formats.
    fn is_new(&mut self, call: &Call) -> bool {
        self.drawn.insert((Arc::as_ptr(&call.pipeline).addr(), call.material))
    }
}
