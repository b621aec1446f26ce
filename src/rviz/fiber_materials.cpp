#include "src/rviz/fiber_materials.hpp"

#include <OgreGpuProgramManager.h>
#include <OgreHighLevelGpuProgram.h>
#include <OgreHighLevelGpuProgramManager.h>
#include <OgreMaterialManager.h>
#include <OgrePass.h>
#include <OgreResourceGroupManager.h>
#include <OgreTechnique.h>

#include <string>

namespace fiber_proximity_rviz {
namespace {

// Turns a ribbon to the viewer, never narrower than a pixel; a line stays where it is. Colours are
// those of a thin cylinder, after Kajiya and Kay 1989: it reflects by the sine of the angle between
// its tangent and the light, and shines where the mirrored angle meets the eye's. The light comes
// over the viewer's left shoulder, so that curls show.
const char* const version = "#version 120\n";
const char* const fiber_shader = R"(
uniform mat4 worldview_matrix;
uniform mat4 projection_matrix;
uniform vec4 viewport_size;

float sine_of(float cosine) { return sqrt(max(0.0, 1.0 - cosine * cosine)); }

vec3 unit(vec3 vector, vec3 otherwise) {
  float size = length(vector);
  return size > 0.0 ? vector / size : otherwise;
}

void main() {
  vec4 position = worldview_matrix * gl_Vertex;
  vec3 tangent = unit(mat3(worldview_matrix) * gl_Normal, vec3(0.0));
  bool parallel_rays = projection_matrix[3][3] == 1.0;
  vec3 eye = parallel_rays ? vec3(0.0, 0.0, 1.0) : -normalize(position.xyz);

  float depth = (projection_matrix * position).w;
  float pixel = 2.0 * depth / (abs(projection_matrix[1][1]) * viewport_size.y);
  float offset = gl_MultiTexCoord0.x;
  vec3 across = unit(cross(eye, tangent), vec3(1.0, 0.0, 0.0));
  if (is_ribbon) {
    position.xyz += sign(offset) * max(abs(offset), 0.5 * pixel) * across;
  }
  gl_Position = projection_matrix * position;

  vec3 light = normalize(vec3(-0.45, 0.65, 0.6));
  float to_light = dot(tangent, light);
  float to_eye = dot(tangent, eye);
  float diffuse = sine_of(to_light);
  float mirrored = max(0.0, sine_of(to_light) * sine_of(to_eye) - to_light * to_eye);
  vec3 color = gl_Color.rgb * (0.15 + 0.85 * diffuse * diffuse) + vec3(0.3 * pow(mirrored, 24.0));
  gl_FrontColor = vec4(min(color, vec3(1.0)), gl_Color.a);
  gl_BackColor = gl_FrontColor;
}
)";

const char* const color_shader = R"(
void main() { gl_FragColor = gl_Color; }
)";

const Ogre::String& group() { return Ogre::ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME; }

/// The program of this name, made the first time; all displays share it.
void make_program(const std::string& name, Ogre::GpuProgramType type, const std::string& source) {
  Ogre::HighLevelGpuProgramManager& programs = Ogre::HighLevelGpuProgramManager::getSingleton();
  if (programs.getResourceByName(name, group()).get() != nullptr) {
    return;
  }
  const Ogre::HighLevelGpuProgramPtr program = programs.createProgram(name, group(), "glsl", type);
  program->setSource(version + source);
  program->load();
  if (type == Ogre::GPT_VERTEX_PROGRAM) {
    const Ogre::GpuProgramParametersSharedPtr parameters = program->getDefaultParameters();
    using Parameters = Ogre::GpuProgramParameters;
    parameters->setNamedAutoConstant("worldview_matrix", Parameters::ACT_WORLDVIEW_MATRIX);
    parameters->setNamedAutoConstant("projection_matrix", Parameters::ACT_PROJECTION_MATRIX);
    parameters->setNamedAutoConstant("viewport_size", Parameters::ACT_VIEWPORT_SIZE);
  }
}

Ogre::MaterialPtr make_material(const std::string& kind) {
  static unsigned count = 0;
  const std::string name = "fiber_proximity/" + kind + std::to_string(count++);
  Ogre::MaterialPtr material = Ogre::MaterialManager::getSingleton().create(name, group());
  material->setReceiveShadows(false);
  return material;
}

Ogre::Pass& pass_of(const Ogre::MaterialPtr& material) {
  return *material->getTechnique(0)->getPass(0);
}

}  // namespace

FiberMaterials::FiberMaterials()
    : tubes_(make_material("tubes")),
      ribbons_(make_material("ribbons")),
      lines_(make_material("lines")) {
  Ogre::Pass& tube = pass_of(tubes_);
  tube.setLightingEnabled(true);
  tube.setVertexColourTracking(Ogre::TVC_AMBIENT | Ogre::TVC_DIFFUSE);
  tube.setSpecular(0.25F, 0.25F, 0.25F, 1.0F);
  tube.setShininess(30.0F);

  Ogre::Pass& ribbon = pass_of(ribbons_);
  Ogre::Pass& line = pass_of(lines_);
  for (Ogre::Pass* pass : {&ribbon, &line}) {
    pass->setLightingEnabled(false);
    pass->setCullingMode(Ogre::CULL_NONE);
  }
  if (Ogre::GpuProgramManager::getSingleton().isSyntaxSupported("glsl")) {
    const std::string shader = fiber_shader;
    make_program("fiber_proximity/ribbon.vert", Ogre::GPT_VERTEX_PROGRAM,
                 "const bool is_ribbon = true;\n" + shader);
    make_program("fiber_proximity/line.vert", Ogre::GPT_VERTEX_PROGRAM,
                 "const bool is_ribbon = false;\n" + shader);
    make_program("fiber_proximity/color.frag", Ogre::GPT_FRAGMENT_PROGRAM, color_shader);
    ribbon.setVertexProgram("fiber_proximity/ribbon.vert");
    line.setVertexProgram("fiber_proximity/line.vert");
    for (Ogre::Pass* pass : {&ribbon, &line}) {
      pass->setFragmentProgram("fiber_proximity/color.frag");
    }
  } else {
    ribbon.setPolygonMode(Ogre::PM_WIREFRAME);  // of no width, all that is to be seen is an edge
  }
}

FiberMaterials::~FiberMaterials() {
  for (const Ogre::MaterialPtr& material : {tubes_, ribbons_, lines_}) {
    Ogre::MaterialManager::getSingleton().remove(material->getHandle());
  }
}

void FiberMaterials::set_transparent(bool transparent) {
  for (const Ogre::MaterialPtr& material : {tubes_, ribbons_, lines_}) {
    Ogre::Pass& pass = pass_of(material);
    pass.setSceneBlending(transparent ? Ogre::SBT_TRANSPARENT_ALPHA : Ogre::SBT_REPLACE);
    pass.setDepthWriteEnabled(!transparent);
  }
}

}  // namespace fiber_proximity_rviz
