//! The list of all methods, one line each. Whatever goes through all of them (modules, choices, settings, dispatch) is made from it.

/// Expands `$then! { $rest… LIST }`. A line is `folder => Type(Options)`; estimators fill several slots.
macro_rules! for_all_methods {
    ($then:ident $($rest:tt)*) => {
        $then! {
            $($rest)*
            direct {
                shadow_map => ShadowMap(ShadowOptions),
                traced => Traced(TracedOptions),
            }
            diffuse {
                ambient => Ambient(AmbientOptions),
                final_gather => FinalGather(FinalGatherOptions),
                lightmaps => Lightmaps(LightmapsOptions),
                particles => Particles(ParticlesOptions),
                rsm => Rsm(RsmOptions),
                volumes => Volumes(VolumesOptions),
                vpl => Vpl(VplOptions),
            }
            caustics {
                photons => Photons(PhotonOptions),
                points => Points(PointOptions),
            }
            specular {
                cubemap => Cubemap(CubemapOptions),
                radiance_maps => RadianceMaps(RadianceMapsOptions),
                trace => Trace(TraceOptions),
            }
            estimator {
                path => Path(PathOptions),
                sppm => Sppm(SppmOptions),
            }
        }
    };
}

/// The modules of a slot's methods: `for_all_methods! { modules diffuse }`.
macro_rules! modules {
    (direct direct $methods:tt diffuse $_2:tt caustics $_3:tt specular $_4:tt estimator $_5:tt) => { modules! { $methods } };
    (diffuse direct $_1:tt diffuse $methods:tt caustics $_3:tt specular $_4:tt estimator $_5:tt) => { modules! { $methods } };
    (caustics direct $_1:tt diffuse $_2:tt caustics $methods:tt specular $_4:tt estimator $_5:tt) => { modules! { $methods } };
    (specular direct $_1:tt diffuse $_2:tt caustics $_3:tt specular $methods:tt estimator $_5:tt) => { modules! { $methods } };
    ({ $($module:ident => $method:ident($options:ident),)* }) => {
        $(pub(crate) mod $module;)*
    };
}

pub(crate) use {for_all_methods, modules};
